#include "moving_checks/point_follower.hpp"

#include <algorithm>
#include <cstdlib>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <utility>

namespace stillpoint::moving {
namespace {

bool far_from_edge(const cv::Mat& image, const cv::Point2f& p, double edge) {
  const double border = std::max(1.0, edge);  // a 3 × 3 patch lies in the image
  return p.x >= border && p.y >= border && p.x <= image.cols - 1 - border &&
         p.y <= image.rows - 1 - border;
}

// Sum of absolute differences of the 3 × 3 px around two points.
int patch_difference(const cv::Mat& a, const cv::Point2f& in_a, const cv::Mat& b,
                     const cv::Point2f& in_b) {
  int sum = 0;
  for (int dy = -1; dy <= 1; ++dy) {
    const std::uint8_t* row_a = a.ptr(cvRound(in_a.y) + dy) + cvRound(in_a.x);
    const std::uint8_t* row_b = b.ptr(cvRound(in_b.y) + dy) + cvRound(in_b.x);
    for (int dx = -1; dx <= 1; ++dx) sum += std::abs(row_a[dx] - row_b[dx]);
  }
  return sum;
}

}  // namespace

void FollowOptions::visit(OptionVisitor& v) {
  corners.visit(v);
  v("window", window, {.min = 5, .max = 101, .unit = "px", .help = "side of the followed patch"});
  v("pyramid_levels", pyramid_levels,
    {.min = 1, .max = 10, .help = "of the flow, the image itself included"});
  v("iterations", iterations, {.min = 1, .max = 1000, .help = "of the flow, per level"});
  v("accuracy", accuracy,
    {.min = 0, .max = 1, .unit = "px", .help = "a smaller step ends the iterations"});
  v("edge", edge,
    {.min = 0, .unit = "px", .help = "a match nearer to the image edge is discarded (III-C)"});
  v("max_patch_difference", max_patch_difference,
    {.min = 0,
     .max = 2295,
     .unit = "grey levels",
     .help = "a match whose 3 x 3 px differ by more in sum is discarded (III-C)"});
}

bool PointFollower::usable(const cv::Mat& previous, const cv::Mat& current) const {
  const int smallest = 2 * (static_cast<int>(options_.edge) + options_.window);
  return previous.type() == CV_8UC1 && current.type() == CV_8UC1 &&
         previous.size() == current.size() && std::min(current.rows, current.cols) >= smallest;
}

PointFollower::Pyramid PointFollower::pyramid_of(const cv::Mat& gray) const {
  Pyramid pyramid{.image = gray, .levels = {}};
  cv::buildOpticalFlowPyramid(gray, pyramid.levels, {options_.window, options_.window},
                              options_.pyramid_levels - 1);
  return pyramid;
}

std::vector<Match> PointFollower::follow(const Frame& previous, const Frame& current,
                                         std::span<const cv::Point2f> kept) {
  if (!usable(previous.gray, current.gray)) return {};
  // While last_ holds the pixels, no other image can lie at their address.
  if (last_.image.data != previous.gray.data || last_.image.size() != previous.gray.size())
    last_ = pyramid_of(previous.gray);
  Pyramid next = pyramid_of(current.gray);
  cv::Mat half;
  if (last_.levels.size() > 2)
    half = last_.levels[2];
  else
    cv::pyrDown(previous.gray, half);
  const double border = std::max(options_.edge, 1.0);
  const Corners corners = find_corners(previous.gray, half, kept, border, options_.corners);
  std::vector<Match> result;
  if (!corners.points.empty()) result = matches(corners, next);
  last_ = std::move(next);
  return result;
}

std::vector<Match> PointFollower::matches(const Corners& corners, const Pyramid& next) const {
  std::vector<cv::Point2f> followed;
  std::vector<std::uint8_t> found;
  cv::calcOpticalFlowPyrLK(
      last_.levels, next.levels, corners.points, followed, found, cv::noArray(),
      {options_.window, options_.window}, options_.pyramid_levels - 1,
      {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, options_.iterations, options_.accuracy});
  std::vector<Match> result;
  for (std::size_t i = 0; i < followed.size(); ++i) {
    const cv::Point2f& from = corners.points[i];
    if (!found[i] || !far_from_edge(last_.image, from, options_.edge) ||
        !far_from_edge(next.image, followed[i], options_.edge))
      continue;
    if (patch_difference(last_.image, from, next.image, followed[i]) >
        options_.max_patch_difference)
      continue;
    result.push_back({from, followed[i], corners.kept_index[i]});
  }
  return result;
}

}  // namespace stillpoint::moving
