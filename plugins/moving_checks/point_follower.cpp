#include "moving_checks/point_follower.hpp"

#include <algorithm>
#include <cstdlib>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <utility>

namespace stillpoint::moving_checks {
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
  v("window", window,
    {.min = 5,
     .max = 101,
     .unit = "px",
     .help = "side of the tracked patch (Algorithm 1, line 1)"});
  v("pyramid_levels", pyramid_levels,
    {.min = 1,
     .max = 10,
     .help = "levels of the flow's pyramid, the image itself included (line 1)"});
  v("iterations", iterations,
    {.min = 1, .max = 1000, .help = "iterations of the flow per level (line 1)"});
  v("accuracy", accuracy,
    {.min = 0, .max = 1, .unit = "px", .help = "a smaller step ends the iterations (line 1)"});
  v("edge", edge,
    {.min = 0,
     .unit = "px",
     .help = "a match nearer to the image edge is discarded (III-C, line 2)"});
  v("max_patch_difference", max_patch_difference,
    {.min = 0,
     .max = 2295,
     .unit = "grey levels",
     .help = "a match whose 3 x 3 px differ by more in sum is discarded (III-C, line 2)"});
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
  // While a pyramid holds the pixels, no other image can lie at their address.
  const auto is_of = [](const Pyramid& pyramid, const cv::Mat& gray) {
    return pyramid.image.data == gray.data && pyramid.image.size() == gray.size();
  };
  if (is_of(current_, previous.gray))
    previous_ = std::move(current_);
  else if (!is_of(previous_, previous.gray))
    previous_ = pyramid_of(previous.gray);
  current_ = pyramid_of(current.gray);
  cv::Mat half;
  if (previous_.levels.size() > 2)
    half = previous_.levels[2];
  else
    cv::pyrDown(previous.gray, half);
  const double border = std::max(options_.edge, 1.0);
  const Corners corners = find_corners(previous.gray, half, kept, border, options_.corners);
  return corners.points.empty() ? std::vector<Match>{} : matches(corners);
}

void PointFollower::track(const std::vector<cv::Point2f>& points,
                          std::vector<cv::Point2f>& followed, std::vector<std::uint8_t>& found,
                          int levels, int flags) const {
  cv::calcOpticalFlowPyrLK(
      previous_.levels, current_.levels, points, followed, found, cv::noArray(),
      {options_.window, options_.window}, levels - 1,
      {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, options_.iterations, options_.accuracy},
      flags);
}

bool PointFollower::accepted(const cv::Point2f& from, const cv::Point2f& to) const {
  return far_from_edge(previous_.image, from, options_.edge) &&
         far_from_edge(current_.image, to, options_.edge) &&
         patch_difference(previous_.image, from, current_.image, to) <=
             options_.max_patch_difference;
}

std::vector<Match> PointFollower::matches(const Corners& corners) const {
  std::vector<cv::Point2f> followed;
  std::vector<std::uint8_t> found;
  track(corners.points, followed, found, options_.pyramid_levels, 0);
  std::vector<Match> result;
  for (std::size_t i = 0; i < followed.size(); ++i)
    if (found[i] && accepted(corners.points[i], followed[i]))
      result.push_back({corners.points[i], followed[i], corners.kept_index[i]});
  return result;
}

std::vector<std::optional<cv::Point2f>> PointFollower::follow_from(
    const std::vector<cv::Point2f>& points, const std::vector<cv::Point2f>& guesses) const {
  std::vector<std::optional<cv::Point2f>> result(points.size());
  if (points.empty() || current_.levels.empty()) return result;
  std::vector<cv::Point2f> followed = guesses;
  std::vector<std::uint8_t> found;
  track(points, followed, found, std::min(2, options_.pyramid_levels),
        cv::OPTFLOW_USE_INITIAL_FLOW);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (found[i] && accepted(points[i], followed[i])) result[i] = followed[i];
  return result;
}

}  // namespace stillpoint::moving_checks
