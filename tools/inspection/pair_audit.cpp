#include "inspection/pair_audit.hpp"

#include <algorithm>
#include <cmath>

#include "stillpoint/error.hpp"
#include "stillpoint/support/exposure.hpp"
#include "stillpoint/support/raw_depth.hpp"
#include "stillpoint/support/size_text.hpp"

namespace stillpoint::inspection {
namespace {

constexpr std::size_t kStretches = 5;  // consecutive images, spread over the recording

/// Begin and end of evenly spread stretches with at most `samples` pairs together.
std::vector<std::pair<std::size_t, std::size_t>> choose_stretches(std::size_t pairs,
                                                                  std::size_t samples) {
  if (pairs == 0) return {};
  const std::size_t length = std::max<std::size_t>(1, std::min(samples, pairs) / kStretches);
  std::vector<std::pair<std::size_t, std::size_t>> stretches;
  for (std::size_t i = 0; i < kStretches; ++i) {
    const std::size_t begin = (pairs - length) * i / (kStretches - 1);
    if (stretches.empty() || begin >= stretches.back().second)
      stretches.emplace_back(begin, begin + length);
  }
  return stretches;
}

std::string kind_of(const RecordedImage& image) {
  const cv::Mat& pixels = image.pixels;
  return size_text(pixels.size()) + ", " + std::to_string(8 * pixels.elemSize1()) + " bit, " +
         std::to_string(pixels.channels()) + (pixels.channels() == 1 ? " channel" : " channels") +
         ", " + image.format;
}

void judge_exposure(const cv::Mat& color, PairAudit& audit) {
  constexpr double kNotWhite = 2.0 / 3;  // share of the values
  constexpr int kWhite = 250;            // level from which a sensor or an encoder saturates
  audit.dark_images += level_quantile(color, kNotBrightest) < kDarkLevel ? 1 : 0;
  audit.overexposed_images += level_quantile(color, kNotWhite) >= kWhite ? 1 : 0;
}

void read_color(const PairReader& reader, std::size_t pair, double time, PairAudit& audit,
                VelocityTrack& motion) {
  try {
    const RecordedImage image = reader.color(pair);
    ++audit.color_kinds[kind_of(image)];
    judge_exposure(image.pixels, audit);
    motion.add_color(time, image.pixels);
  } catch (const Error& error) {
    audit.unreadable.emplace_back(error.what());
  }
}

void read_depth(const PairReader& reader, std::size_t pair, double time, PairAudit& audit,
                VelocityTrack& motion) {
  try {
    const RecordedImage image = reader.depth(pair);
    ++audit.depth_kinds[kind_of(image)];
    const cv::Mat raw = image.pixels.type() == CV_32FC1
                            ? raw_depth(image.pixels, audit.depth_factor)
                            : image.pixels;
    audit.depth_values.add(raw);
    motion.add_depth(time, raw);
  } catch (const Error& error) {
    audit.unreadable.emplace_back(error.what());
  }
}

}  // namespace

void audit_stamps(const std::vector<double>& color, const std::vector<double>& depth,
                  const std::vector<PairStamps>& pairs, PairAudit& audit) {
  audit.color = audit_stream(color);
  audit.depth = audit_stream(depth);
  std::vector<double> times;
  for (const PairStamps& pair : pairs) {
    const double difference = std::abs(pair.color - pair.depth);
    audit.max_difference = std::max(audit.max_difference, difference);
    audit.mean_difference += difference / static_cast<double>(pairs.size());
    times.push_back(pair.color);
  }
  audit.pairs = audit_stream(times);
}

void audit_images(const std::vector<PairStamps>& pairs, const PairReader& reader, int samples,
                  PairAudit& audit) {
  std::vector<MotionStretch> motion;
  for (const auto& [begin, end] : choose_stretches(pairs.size(), std::max(1, samples))) {
    motion.emplace_back();
    for (std::size_t i = begin; i < end; ++i) {
      ++audit.sampled;
      read_color(reader, i, pairs[i].color, audit, motion.back().color);
      read_depth(reader, i, pairs[i].depth, audit, motion.back().depth);
    }
  }
  audit.time_offset = estimate_time_offset(motion);
}

}  // namespace stillpoint::inspection
