// Everything `stillpoint inspect` finds out about a bag.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bag/bag_reader.hpp"
#include "bag/topic_choice.hpp"
#include "inspection/stream_audit.hpp"
#include "stillpoint/contracts/camera.hpp"

namespace stillpoint::inspection {

struct BagAuditOptions {
  bag::TopicNames topics;
  std::optional<CameraModel> camera;  ///< instead of the bag's
  double max_difference = 0.02;       ///< seconds
  double time_offset = 0.0;           ///< seconds, added to depth stamps
};

struct TopicAudit {
  bag::Topic topic;
  StreamAudit messages;  ///< by the time of their arrival
  std::string images;    ///< "640 x 480, rgb8"; empty without images
};

struct BagAudit {
  std::filesystem::path path;
  std::string format;
  std::uintmax_t bytes = 0;  ///< of all its files
  std::vector<TopicAudit> topics;
  // What a run would use; without a choice, a warning has the reason.
  std::optional<bag::TopicChoice> choice;
  std::optional<CameraModel> camera;
  StreamAudit color, depth, pairs;  ///< by stamps of exposure
  double mean_difference = 0.0;     ///< seconds between colour and depth of a pair
  double max_difference = 0.0;      ///< seconds
  std::vector<std::string> warnings;
};

/// Throws Error(kData) when it is no bag; all else is a finding.
BagAudit audit_bag(const std::filesystem::path& path, const BagAuditOptions& options);

std::string report_table(const BagAudit& audit);
nlohmann::ordered_json report_json(const BagAudit& audit);

}  // namespace stillpoint::inspection
