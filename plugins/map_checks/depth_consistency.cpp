#include "map_checks/depth_consistency.hpp"

#include <algorithm>
#include <vector>

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

MapEvidence DepthConsistency::check(const Frame& frame, std::span<const Pose> guesses,
                                    const SparseMap& map) {
  const cv::Mat depth = sample_depth(frame.depth);
  const CellCamera camera(*frame.camera);
  std::vector<const View*> views;
  std::vector<std::pair<double, const View*>> by_overlap;
  for (const View& view : memory_.views_in(map)) {
    const double share = overlap(view, depth, camera, guesses.front());
    if (share < kMinViewOverlap) continue;
    views.push_back(&view);
    by_overlap.emplace_back(-share, &view);
  }
  if (views.empty()) return {};
  std::ranges::stable_sort(by_overlap, {}, &std::pair<double, const View*>::first);
  std::vector<const View*> best;
  for (const auto& [share, view] : by_overlap) best.push_back(view);
  const ViewAlignment alignment = align(depth, camera, guesses, best);
  if (alignment.agreement < options_.min_agreement) return {};
  return {surface_evidence(depth, camera, alignment.world_from_camera, frame.time, views,
                           options_.surface)};
}

}  // namespace stillpoint::map_checks
