#include "inspection/recording_audit.hpp"

#include <algorithm>
#include <cmath>

#include "inspection/audit_warnings.hpp"
#include "stillpoint/error.hpp"
#include "stillpoint/support/exposure.hpp"
#include "tum_recording/image_reader.hpp"

namespace stillpoint::inspection {
namespace {

using tum_recording::ImageReader;
using tum_recording::open_recording;
using tum_recording::StampedImage;

constexpr std::size_t kStretches = 5;  // consecutive images, spread over the recording

/// Begin and end of evenly spread stretches with at most `samples` pairs together.
std::vector<std::pair<std::size_t, std::size_t>> choose_stretches(std::size_t pairs,
                                                                  std::size_t samples) {
  const std::size_t length = std::max<std::size_t>(1, std::min(samples, pairs) / kStretches);
  std::vector<std::pair<std::size_t, std::size_t>> stretches;
  for (std::size_t i = 0; i < kStretches; ++i) {
    const std::size_t begin = (pairs - length) * i / (kStretches - 1);
    if (stretches.empty() || begin >= stretches.back().second)
      stretches.emplace_back(begin, begin + length);
  }
  return stretches;
}

std::string kind_of(const cv::Mat& image, const std::filesystem::path& file) {
  return std::to_string(image.cols) + " x " + std::to_string(image.rows) + ", " +
         std::to_string(8 * image.elemSize1()) + " bit, " + std::to_string(image.channels()) +
         (image.channels() == 1 ? " channel" : " channels") + ", " +
         file.extension().string().substr(file.has_extension() ? 1 : 0);
}

void judge_exposure(const cv::Mat& color, RecordingAudit& audit) {
  constexpr double kNotWhite = 2.0 / 3;  // share of the values
  constexpr int kWhite = 250;            // level from which a sensor or an encoder saturates
  audit.dark_images += level_quantile(color, kNotBrightest) < kDarkLevel ? 1 : 0;
  audit.overexposed_images += level_quantile(color, kNotWhite) >= kWhite ? 1 : 0;
}

/// Reads the images of one pair; one that cannot be used is a finding.
void read_pair(const ImagePair& pair, ImageReader& reader, RecordingAudit& audit,
               MotionStretch& motion) {
  ++audit.sampled;
  try {
    const cv::Mat color = reader.color(pair.color.file);
    ++audit.color_kinds[kind_of(color, pair.color.file)];
    judge_exposure(color, audit);
    motion.color.add_color(pair.color.time, color);
  } catch (const Error& error) {
    audit.unreadable.push_back(error.what());
  }
  try {
    const cv::Mat depth = reader.depth(pair.depth.file);
    ++audit.depth_kinds[kind_of(depth, pair.depth.file)];
    audit.depth_values.add(depth);
    motion.depth.add_depth(pair.depth.time, depth);
  } catch (const Error& error) {
    audit.unreadable.push_back(error.what());
  }
}

void read_images(RecordingAudit& audit, int samples) {
  ImageReader reader;
  std::vector<MotionStretch> motion;
  const auto& pairs = audit.recording.pairs;
  for (const auto& [begin, end] : choose_stretches(pairs.size(), std::max(1, samples))) {
    motion.emplace_back();
    for (std::size_t i = begin; i < end; ++i) read_pair(pairs[i], reader, audit, motion.back());
  }
  audit.time_offset = estimate_time_offset(motion);
}

void compare_stamps(RecordingAudit& audit) {
  for (const ImagePair& pair : audit.recording.pairs) {
    const double difference = std::abs(pair.color.time - pair.depth.time);
    audit.max_difference = std::max(audit.max_difference, difference);
    audit.mean_difference += difference / static_cast<double>(audit.recording.pairs.size());
  }
}

std::vector<double> times_of(const std::vector<StampedImage>& images) {
  std::vector<double> times;
  for (const StampedImage& image : images) times.push_back(image.time);
  return times;
}

std::vector<double> times_of(const std::vector<ImagePair>& pairs) {
  std::vector<double> times;
  for (const ImagePair& pair : pairs) times.push_back(pair.color.time);
  return times;
}

}  // namespace

RecordingAudit audit_recording(const std::filesystem::path& folder, const AuditOptions& options) {
  RecordingAudit audit{.recording = open_recording(folder, options.pairing),
                       .camera = options.camera};
  if (audit.camera) audit.depth_factor = audit.camera->depth_factor;
  audit.color = audit_stream(times_of(audit.recording.color));
  audit.depth = audit_stream(times_of(audit.recording.depth));
  audit.pairs = audit_stream(times_of(audit.recording.pairs));
  compare_stamps(audit);
  read_images(audit, options.samples);
  if (!audit.recording.ground_truth.empty())
    audit.truth = audit_truth(audit.recording.ground_truth, audit.recording.pairs);
  audit.warnings = audit_warnings(audit, options.pairing);
  return audit;
}

}  // namespace stillpoint::inspection
