#include "inspection/time_offset.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>

namespace stillpoint::inspection {
namespace {

const cv::Size kSmall(160, 120);
constexpr double kStep = 0.005;    // seconds
constexpr int kMaxSteps = 30;      // of the offset that is looked for
constexpr int kParabolaSteps = 4;  // on either side of the best step
// A peak is clear when the correlation falls by so much on both sides. While the camera moves
// steadily, all offsets are about as good.
constexpr int kFallSteps = 20;
constexpr double kMinFall = 0.1;
constexpr int kCurveSteps = kMaxSteps + kFallSteps;
constexpr std::size_t kMinVelocities = 10;  // per stretch, that both sensors have
constexpr double kMinSpeed = 0.05;          // image widths per second
constexpr double kMinCorrelation = 0.7;
constexpr double kMaxDeviation = 0.010;  // seconds

/// Sums from which the agreement of the velocities of both sensors follows.
struct Agreement {
  double color = 0.0, depth = 0.0, both = 0.0;
  std::size_t count = 0;

  double correlation() const {
    return color > 0 && depth > 0 ? both / std::sqrt(color * depth) : 0.0;
  }
  Agreement& operator+=(const Agreement& other) {
    color += other.color;
    depth += other.depth;
    both += other.both;
    count += other.count;
    return *this;
  }
};

/// Linear between samples; nothing outside of them.
std::optional<cv::Point2d> velocity_at(const std::vector<PictureVelocity>& velocities,
                                       double time) {
  const auto after =
      std::lower_bound(velocities.begin(), velocities.end(), time,
                       [](const PictureVelocity& sample, double t) { return sample.time < t; });
  if (after == velocities.begin() || after == velocities.end()) return std::nullopt;
  const auto before = after - 1;
  const double share = (time - before->time) / (after->time - before->time);
  return before->velocity * (1 - share) + after->velocity * share;
}

/// `samples` against `other` shifted by `shift` seconds.
Agreement compare(const std::vector<PictureVelocity>& samples,
                  const std::vector<PictureVelocity>& other, double shift) {
  Agreement agreement;
  for (const PictureVelocity& sample : samples) {
    const auto velocity = velocity_at(other, sample.time - shift);
    if (!velocity) continue;
    agreement.color += sample.velocity.dot(sample.velocity);
    agreement.depth += velocity->dot(*velocity);
    agreement.both += sample.velocity.dot(*velocity);
    ++agreement.count;
  }
  return agreement;
}

/// Agreement at every offset up to kCurveSteps in both directions. Interpolation smooths one of the
/// two signals, so that each is interpolated in turn.
std::vector<Agreement> agreement_curve(const MotionStretch& stretch) {
  std::vector<Agreement> curve;
  for (int i = -kCurveSteps; i <= kCurveSteps; ++i) {
    Agreement agreement =
        compare(stretch.color.velocities(), stretch.depth.velocities(), i * kStep);
    agreement += compare(stretch.depth.velocities(), stretch.color.velocities(), -i * kStep);
    curve.push_back(agreement);
  }
  return curve;
}

/// The step of kMaxSteps on either side at which the correlation is largest.
int best_step(const std::vector<Agreement>& curve) {
  const auto zero = curve.begin() + kCurveSteps;
  const auto best = std::max_element(
      zero - kMaxSteps, zero + kMaxSteps + 1,
      [](const Agreement& a, const Agreement& b) { return a.correlation() < b.correlation(); });
  return static_cast<int>(best - zero);
}

/// Top of the parabola through the correlations around the best step; nothing at the border, and
/// where the peak is not clear.
std::optional<double> best_offset(const std::vector<Agreement>& curve) {
  const int best = best_step(curve);
  const auto correlation = [&](int step) { return curve[kCurveSteps + step].correlation(); };
  if (std::abs(best) + kParabolaSteps > kMaxSteps) return std::nullopt;
  if (std::max(correlation(best - kFallSteps), correlation(best + kFallSteps)) >
      correlation(best) - kMinFall)
    return std::nullopt;
  cv::Mat_<double> terms(2 * kParabolaSteps + 1, 3), values(2 * kParabolaSteps + 1, 1), solution;
  for (int i = -kParabolaSteps; i <= kParabolaSteps; ++i) {
    terms(i + kParabolaSteps, 0) = 1.0;
    terms(i + kParabolaSteps, 1) = i;
    terms(i + kParabolaSteps, 2) = i * i;
    values(i + kParabolaSteps) = correlation(best + i);
  }
  cv::solve(terms, values, solution, cv::DECOMP_QR);
  if (solution(2) >= 0) return std::nullopt;
  const double top =
      std::clamp(-solution(1) / (2 * solution(2)), -1.0 * kParabolaSteps, 1.0 * kParabolaSteps);
  return (best + top) * kStep;
}

double standard_error(const std::vector<double>& values) {
  double mean = 0.0, squares = 0.0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  for (const double value : values) squares += (value - mean) * (value - mean);
  const double count = static_cast<double>(values.size());
  return std::sqrt(squares / (count - 1) / count);
}

double speed(const Agreement& agreement) {
  return agreement.count == 0 ? 0.0
                              : std::sqrt(agreement.color / static_cast<double>(agreement.count));
}

}  // namespace

void VelocityTrack::add_color(double time, const cv::Mat& bgr) {
  cv::Mat gray, small;
  cv::cvtColor(bgr, gray, cv::COLOR_BGR2GRAY);
  cv::resize(gray, small, kSmall, 0, 0, cv::INTER_AREA);
  small.convertTo(small, CV_32F);
  add(time, small);
}

/// Inverse depth: edges of near things, which move most, stand out most, and holes are as dark as
/// the far background.
void VelocityTrack::add_depth(double time, const cv::Mat& raw) {
  cv::Mat inverse(raw.size(), CV_32FC1), small;
  for (int y = 0; y < raw.rows; ++y) {
    const auto* in = raw.ptr<std::uint16_t>(y);
    auto* out = inverse.ptr<float>(y);
    for (int x = 0; x < raw.cols; ++x) out[x] = in[x] > 0 ? 1000.f / in[x] : 0.f;
  }
  cv::resize(inverse, small, kSmall, 0, 0, cv::INTER_AREA);
  add(time, small);
}

void VelocityTrack::add(double time, const cv::Mat& small) {
  if (!previous_.empty() && time > previous_time_) {
    cv::Mat window;
    cv::createHanningWindow(window, kSmall, CV_32F);
    const cv::Point2d shift = cv::phaseCorrelate(previous_, small, window);
    velocities_.push_back(
        {(previous_time_ + time) / 2, shift / (kSmall.width * (time - previous_time_))});
  }
  previous_ = small;
  previous_time_ = time;
}

TimeOffset estimate_time_offset(std::span<const MotionStretch> stretches) {
  TimeOffset result;
  std::vector<Agreement> total(2 * kCurveSteps + 1);
  std::vector<double> offsets;  // one per stretch that moves
  std::size_t usable = 0;
  for (const MotionStretch& stretch : stretches) {
    const auto curve = agreement_curve(stretch);
    const Agreement& middle = curve[kCurveSteps];
    if (middle.count < 2 * kMinVelocities || speed(middle) < kMinSpeed) continue;
    ++usable;
    for (std::size_t i = 0; i < total.size(); ++i) total[i] += curve[i];
    if (const auto offset = best_offset(curve)) offsets.push_back(*offset);
  }
  if (usable == 0) {
    result.reason = "the camera hardly moves or the recording is too short";
    return result;
  }
  result.correlation = total[kCurveSteps + best_step(total)].correlation();
  if (result.correlation < kMinCorrelation) {
    result.reason = "colour and depth do not move alike at any offset within 150 ms";
    return result;
  }
  const auto offset = best_offset(total);
  if (!offset) {
    result.reason = "no offset within 150 ms fits clearly best: the camera moves too steadily";
    return result;
  }
  result.offset = *offset;
  if (offsets.size() >= 2) result.deviation = standard_error(offsets);
  if (offsets.size() < 2 || result.deviation > kMaxDeviation) {
    result.reason = "the parts of the recording do not agree on it";
    return result;
  }
  result.known = true;
  return result;
}

}  // namespace stillpoint::inspection
