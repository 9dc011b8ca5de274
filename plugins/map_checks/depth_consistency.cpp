#include "map_checks/depth_consistency.hpp"

#include <algorithm>
#include <functional>
#include <utility>

namespace stillpoint::map_checks {
namespace {

constexpr double kMinViewOverlap = 0.1;

/// Share of the cells with depth that project into the image of a view; sampled.
double overlap(const View& view, const cv::Mat& depth, const CellCamera& camera,
               const Pose& world_from_camera) {
  constexpr int kStep = 16;  // cells
  const Eigen::Isometry3f view_from_camera =
      (view.world_from_camera.inverse() * world_from_camera).cast<float>();
  const cv::Rect inside({}, view.depth.size());
  int points = 0, seen = 0;
  for (int y = kStep / 2; y < depth.rows; y += kStep)
    for (int x = kStep / 2; x < depth.cols; x += kStep) {
      const float z = depth.at<float>(y, x);
      if (z <= 0) continue;
      ++points;
      const Eigen::Vector3f p =
          view_from_camera * camera.unproject(static_cast<float>(x), static_cast<float>(y), z);
      if (p.z() <= 0) continue;
      seen += inside.contains(cv::Point(cvRound(view.camera.fx * p.x() / p.z() + view.camera.cx),
                                        cvRound(view.camera.fy * p.y() / p.z() + view.camera.cy)));
    }
  return points > 0 ? static_cast<double>(seen) / points : 0.0;
}

}  // namespace

void DepthConsistency::Options::visit(OptionVisitor& v) {
  memory.visit(v);
  surface.visit(v);
  v("min_agreement", min_agreement,
    {.min = 0,
     .max = 1,
     .help = "share of the points on or behind trusted surfaces that lie on them; with less, the "
             "frame's pose is in doubt and there is no "
             "evidence"});
}

std::vector<const View*> DepthConsistency::overlapping_views(const cv::Mat& depth,
                                                             const CellCamera& camera,
                                                             const Pose& world_from_camera) const {
  std::vector<std::pair<double, const View*>> by_overlap;
  for (const View& view : memory_.views()) {
    const double share = overlap(view, depth, camera, world_from_camera);
    if (share >= kMinViewOverlap) by_overlap.emplace_back(-share, &view);
  }
  std::ranges::stable_sort(by_overlap, {}, &std::pair<double, const View*>::first);
  std::vector<const View*> views;
  for (const auto& [share, view] : by_overlap) views.push_back(view);
  return views;
}

MapEvidence DepthConsistency::check(const Frame& frame, std::span<const Pose> guesses,
                                    const SparseMap& map) {
  const cv::Mat depth = sample_depth(frame.depth);
  const CellCamera camera(*frame.camera);
  memory_.move_to(map);
  std::vector<const View*> views = overlapping_views(depth, camera, guesses.front());
  if (views.empty()) return {};
  const ViewAlignment alignment = align(depth, camera, guesses, views);
  if (alignment.agreement < options_.min_agreement) return {};
  std::ranges::sort(views, std::greater(), &View::time);
  return {surface_evidence(depth, camera, alignment.world_from_camera, frame.time, views,
                           options_.surface)};
}

void DepthConsistency::remember(const TrackedFrame& frame) {
  if (!memory_.is_new_view(frame)) return;
  View view = make_view(frame);
  const std::vector<const View*> others =
      overlapping_views(view.depth, view.camera, view.world_from_camera);
  if (!others.empty()) {
    view.tracked_from_depth = tracked_from_depth(view, others, options_.min_agreement);
    view.world_from_camera = view.world_from_camera * view.tracked_from_depth;
  }
  memory_.add(std::move(view));
}

}  // namespace stillpoint::map_checks
