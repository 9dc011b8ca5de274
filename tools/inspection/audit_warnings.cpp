#include "inspection/audit_warnings.hpp"

#include <cmath>

#include "inspection/number_text.hpp"
#include "stillpoint/support/size_text.hpp"

namespace stillpoint::inspection {
namespace {

using Warnings = std::vector<std::string>;

void check_sizes(const std::map<std::string, int>& kinds, const std::optional<CameraModel>& camera,
                 Warnings& warnings) {
  if (!camera) return;
  const std::string size = size_text({camera->width, camera->height});
  for (const auto& [kind, count] : kinds)
    if (!kind.starts_with(size + ","))
      warnings.push_back(std::to_string(count) + " sampled images are " + kind + ", but camera '" +
                         camera->name + "' has " + size + "; choose another camera");
}

void check_images(const PairAudit& audit, Warnings& warnings) {
  if (!audit.unreadable.empty())
    warnings.push_back(std::to_string(audit.unreadable.size()) + " of " +
                       std::to_string(2 * audit.sampled) +
                       " sampled images cannot be used; first: " + audit.unreadable.front());
  if (audit.color_kinds.size() > 1) warnings.push_back("colour images differ in size or type");
  if (audit.depth_kinds.size() > 1) warnings.push_back("depth images differ in size or type");
  check_sizes(audit.color_kinds, audit.camera, warnings);
  check_sizes(audit.depth_kinds, audit.depth_camera ? audit.depth_camera : audit.camera, warnings);
}

void check_exposure(const PairAudit& audit, Warnings& warnings) {
  const std::string all = " of " + std::to_string(audit.sampled) + " sampled colour images are ";
  if (audit.dark_images > 0)
    warnings.push_back(std::to_string(audit.dark_images) + all +
                       "dark; a network may miss people there, and tracking has fewer features");
  if (audit.overexposed_images > 0)
    warnings.push_back(std::to_string(audit.overexposed_images) + all +
                       "over-exposed, a third or more of them white; nothing can be tracked there");
}

void check_depth(const PairAudit& audit, Warnings& warnings) {
  const DepthStatistics& depth = audit.depth_values;
  if (depth.images() == 0) return;
  if (depth.empty_images() > 0)
    warnings.push_back(std::to_string(depth.empty_images()) + " of " +
                       std::to_string(depth.images()) +
                       " sampled depth images hold no measurement; such frames are skipped");
  if (depth.empty_images() == depth.images()) return;
  if (depth.valid_share() < 0.3)
    warnings.push_back("only " + percent(depth.valid_share()) +
                       " of the depth pixels hold a measurement");
  // Depth cameras of this kind measure from 0.5 m to about 10 m.
  const double median = depth.quantile(0.5) / audit.depth_factor;
  const double far = depth.quantile(0.95) / audit.depth_factor;
  if (median >= 0.5 && far <= 12.0) return;
  std::string advice = "check the camera's depth_factor";
  const double other = audit.depth_factor == 1000.0 ? 5000.0 : 1000.0;
  const double other_median = depth.quantile(0.5) / other;
  if (other_median >= 0.5 && depth.quantile(0.95) / other <= 12.0)
    advice += "; with " + fixed(other, 0) + " the median would be " + fixed(other_median, 2) + " m";
  warnings.push_back("depth is implausible: half of it is nearer than " + fixed(median, 2) +
                     " m, 95 % nearer than " + fixed(far, 2) + " m; " + advice);
}

void check_times(const PairAudit& audit, double max_difference, Warnings& warnings) {
  const std::size_t unpaired = audit.color.images - audit.pairs.images;
  if (unpaired * 20 > audit.color.images)
    warnings.push_back(std::to_string(unpaired) + " of " + std::to_string(audit.color.images) +
                       " colour images have no depth image within " +
                       fixed(1e3 * max_difference, 0) +
                       " ms; change max_difference or time_offset of the source");
  if (audit.pairs.gaps.empty() || audit.pairs.gaps[0].length < 0.5) return;
  warnings.push_back("no frames for " + fixed(audit.pairs.gaps[0].length, 2) + " s from " +
                     fixed(audit.pairs.gaps[0].begin, 3) + " s; tracking may get lost there");
}

void check_offset(const PairAudit& audit, const std::string& advice, Warnings& warnings) {
  const TimeOffset& offset = audit.time_offset;
  const double worth_telling = std::max(0.010, 3 * offset.deviation);  // seconds
  if (!offset.known || std::abs(offset.offset) < worth_telling) return;
  warnings.push_back("depth is stamped " + fixed(1e3 * std::abs(offset.offset), 0) + " ms too " +
                     (offset.offset < 0 ? "late; " : "early; ") + advice);
}

void check_truth(const RecordingAudit& audit, Warnings& warnings) {
  if (!audit.truth) return;
  if (audit.truth->unusable_lines > 0)
    warnings.push_back(std::to_string(audit.truth->unusable_lines) +
                       " lines of the ground truth are unusable and left out; first: " +
                       audit.truth->first_unusable);
  if (audit.truth->covered < 0.95)
    warnings.push_back("ground truth covers " + percent(audit.truth->covered) + " of the frames");
}

}  // namespace

Warnings pair_warnings(const PairAudit& audit, double max_difference,
                       const std::string& offset_advice) {
  Warnings warnings;
  check_images(audit, warnings);
  check_exposure(audit, warnings);
  check_depth(audit, warnings);
  check_times(audit, max_difference, warnings);
  check_offset(audit, offset_advice, warnings);
  return warnings;
}

std::string time_offset_advice(double time_offset) {
  return "try time_offset: " + fixed(time_offset, 3) + " in the source section";
}

Warnings audit_warnings(const RecordingAudit& audit, const RecordingOptions& pairing) {
  const std::string from = audit.recording.pairs_from.filename().string();
  Warnings warnings = pair_warnings(
      audit, pairing.max_difference,
      from.empty()
          ? time_offset_advice(pairing.time_offset + audit.time_offset.offset)
          : "with rgb.txt and depth.txt instead of " + from + ", time_offset could correct it");
  check_truth(audit, warnings);
  warnings.insert(warnings.end(), audit.recording.warnings.begin(), audit.recording.warnings.end());
  return warnings;
}

}  // namespace stillpoint::inspection
