#include "orb_slam/moving_area.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "orb_slam/landmark_geometry.hpp"
#include "orb_slam/observed_frame.hpp"
#include "stillpoint/support/pixel_scale.hpp"

namespace stillpoint::orb_slam {
namespace {

constexpr double kRecent = 5.0;     // seconds
constexpr double kMinShare = 0.02;  // of the image: less is noise of masks and depth
// px of 640 x 480: background that may be disoccluded until the next frame.
constexpr double kDisocclusion = 8;

cv::Mat unmapped(const StaticWeights& weights) {
  cv::Mat used;
  if (!weights.track.empty()) used = weights.track >= ObservedFrame::kMinWeight;
  if (!weights.map.empty()) {
    const cv::Mat mapped = weights.map >= kMinMapWeight;
    used = used.empty() ? mapped : cv::Mat(used & mapped);
  }
  if (used.empty()) return {};
  const int side = 2 * cvRound(kDisocclusion * pixel_scale(used.size())) + 1;
  cv::dilate(used, used, cv::Mat::ones(side, side, CV_8U));
  return used == 0;
}

}  // namespace

void MovingArea::update(const StaticWeights& weights, double time) {
  mask_ = unmapped(weights);
  share_ = mask_.empty() ? 0.0 : cv::countNonZero(mask_) / static_cast<double>(mask_.total());
  if (share_ > kMinShare) last_time_ = time;
}

double MovingArea::feature_factor(double most) const {
  return std::min(1 / ((1 - share_) * (1 - share_)), most);
}

bool MovingArea::recent(double time) const { return time - last_time_ < kRecent; }

}  // namespace stillpoint::orb_slam
