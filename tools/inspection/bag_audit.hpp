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
#include "inspection/pair_audit.hpp"
#include "stillpoint/pose_math.hpp"

namespace stillpoint::inspection {

struct BagAuditOptions {
  bag::TopicNames topics;
  std::optional<CameraModel> camera;  ///< instead of the bag's
  double max_difference = 0.02;       ///< seconds
  double time_offset = 0.0;           ///< seconds, added to depth stamps
  int samples = 200;                  ///< pairs whose images are read
};

struct TopicAudit {
  bag::Topic topic;
  StreamAudit messages;  ///< by the time of their arrival
  std::string images;    ///< "640 x 480, rgb8"; empty without images
};

/// Images and cameras are those that a run would use, by stamps of exposure; without a choice of
/// topics, a warning has the reason.
struct BagAudit : PairAudit {
  std::filesystem::path path;
  std::string format;
  std::uintmax_t bytes = 0;  ///< of all its files
  std::vector<TopicAudit> topics;
  std::optional<bag::TopicChoice> choice;
  std::optional<Pose> color_from_depth;  ///< as the bag says, of depth that is not registered
};

/// Throws Error(kData) when it is no bag; all else is a finding.
BagAudit audit_bag(const std::filesystem::path& path, const BagAuditOptions& options);

std::string report_table(const BagAudit& audit);
nlohmann::ordered_json report_json(const BagAudit& audit);

}  // namespace stillpoint::inspection
