#include "propagator_flow_depth/point_follower.hpp"

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "stillpoint/support/depth_step.hpp"

namespace stillpoint::propagator_flow_depth {
namespace {

constexpr int kLevels = 3;
const cv::Size kWindow(13, 13);             // px of a view: 26 px of the frame
constexpr DepthStep kJump{.share = 0.08f};  // from one view to the next

using Points = std::vector<cv::Point2f>;

Points flow(const View& from, const View& to, const Points& points,
            std::vector<unsigned char>& found) {
  Points moved;
  cv::calcOpticalFlowPyrLK(from.pyramid, to.pyramid, points, moved, found, cv::noArray(), kWindow,
                           kLevels, {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 8, 0.03});
  return moved;
}

bool inside(cv::Point2f point, cv::Size size) {
  return point.x >= 0 && point.y >= 0 && point.x <= static_cast<float>(size.width - 1) &&
         point.y <= static_cast<float>(size.height - 1);
}

bool jumps(float before, float after) {
  return before > 0 && after > 0 && kJump.is_between(before, after);
}

}  // namespace

void build_flow_pyramid(const cv::Mat& gray, std::vector<cv::Mat>& pyramid) {
  cv::buildOpticalFlowPyramid(gray, pyramid, kWindow, kLevels);
}

std::vector<Track> choose_points(const View& view, const cv::Mat& mask, cv::Rect box, int most) {
  cv::Mat inner;
  cv::erode(mask, inner, cv::getStructuringElement(cv::MORPH_RECT, {5, 5}), {-1, -1}, 1,
            cv::BORDER_CONSTANT, cv::Scalar(255));
  Points corners;
  cv::goodFeaturesToTrack(view.pyramid[0](box), corners, most, 0.01, 3.0, inner);
  std::vector<Track> tracks;
  for (const cv::Point2f& corner : corners) {
    const cv::Point2f position = corner + cv::Point2f(box.tl());
    const float depth = depth_at(view, position);
    tracks.push_back({position, position, depth, depth});
  }
  return tracks;
}

void follow(const View& from, const View& to, std::span<Track*> tracks, float max_error) {
  Points points;
  std::vector<Track*> followed;
  for (Track* track : tracks) {
    if (track->lost) continue;
    points.push_back(track->current);
    followed.push_back(track);
  }
  if (points.empty()) return;
  std::vector<unsigned char> found, found_back;
  const Points moved = flow(from, to, points, found);
  const Points back = flow(to, from, moved, found_back);
  for (std::size_t i = 0; i < followed.size(); ++i) {
    Track& track = *followed[i];
    const float depth = inside(moved[i], to.size()) ? depth_at(to, moved[i]) : 0.0f;
    const cv::Point2f error = back[i] - points[i];
    track.lost = !found[i] || !found_back[i] || !inside(moved[i], to.size()) ||
                 std::hypot(error.x, error.y) > max_error || jumps(track.current_depth, depth);
    track.current = moved[i];
    if (depth > 0) track.current_depth = depth;
  }
}

}  // namespace stillpoint::propagator_flow_depth
