#include "people/depth_sensor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "simulation/noise.hpp"

namespace stillpoint::people {
namespace {

using simulation::RowNoise;
using simulation::Stream;

// A Kinect: Khoshelham and Elberink, Sensors 2012. Errors grow with the square of the distance.
constexpr float kBaselineFocal = 43.5F;  // px m
constexpr float kStep = 0.125F;          // px of disparity
constexpr float kNoise = 0.055F;         // px of disparity, standard deviation
constexpr float kNearestSensed = 0.4F;   // m
constexpr float kEdgeLoss = 0.5F;        // share of the pixels lost along outlines
constexpr int kWindow = 5;               // px over which errors are shared

/// Disparity errors: normal values of which 0.7 of the variance is shared by neighbours.
cv::Mat disparity_noise(cv::Size size, std::uint32_t seed, std::uint32_t frame) {
  cv::Mat white(size, CV_32F), shared;
  for (int y = 0; y < size.height; ++y) {
    const RowNoise random(seed, frame, Stream::kDepthWhite, y);
    for (int x = 0; x < size.width; ++x) white.at<float>(y, x) = random.normal(x);
  }
  cv::blur(white, shared, {kWindow, kWindow});
  return kNoise * (std::sqrt(0.3F) * white + std::sqrt(0.7F) * kWindow * shared);
}

/// The scene left of something nearer: the projector's light on a pixel left it in column
/// x - bf / z, and what is nearer keeps it off what is farther.
void cast_shadow(const float* z, int width, float* depth) {
  float covered = std::numeric_limits<float>::infinity();
  for (int x = width - 1; x >= 0; --x) {
    if (z[x] > 0) {
      covered = std::min(covered, static_cast<float>(x) - kBaselineFocal / z[x]);
    } else if (depth[x] > 0 && static_cast<float>(x) - kBaselineFocal / depth[x] > covered) {
      depth[x] = 0;
    }
  }
}

float measured(float z, float noise) {
  const float disparity = kBaselineFocal / z + noise;
  return kBaselineFocal / (kStep * std::max(1.0F, std::round(disparity / kStep)));
}

}  // namespace

void measure(const cv::Mat& z, std::uint32_t seed, std::uint32_t frame, cv::Mat& depth) {
  if (cv::countNonZero(z) == 0) return;
  cv::Mat inner;
  cv::erode(z > 0, inner, cv::Mat::ones(3, 3, CV_8U));
  const cv::Mat noise = disparity_noise(z.size(), seed, frame);
  for (int y = 0; y < z.rows; ++y) {
    const float* pasted = z.ptr<float>(y);
    float* out = depth.ptr<float>(y);
    cast_shadow(pasted, z.cols, out);
    const RowNoise losses(seed, frame, Stream::kDepthJitter, y);
    for (int x = 0; x < z.cols; ++x) {
      if (pasted[x] <= 0) continue;
      const bool lost = pasted[x] < kNearestSensed ||
                        (inner.at<std::uint8_t>(y, x) == 0 && losses.uniform(x) < kEdgeLoss);
      out[x] = lost ? 0 : measured(pasted[x], noise.at<float>(y, x));
    }
  }
}

}  // namespace stillpoint::people
