#include "orb_slam/reference_views.hpp"

#include <algorithm>
#include <utility>

namespace stillpoint::orb_slam {
namespace {

constexpr std::size_t kMaxViews = 40;      // kept; 130 kB each
constexpr std::size_t kComparedViews = 2;  // compared with
constexpr int kSparse = 6;                 // overlap is sampled at every sixth patch and row
constexpr double kMinOverlap = 0.15;       // of the patches
constexpr double kMinGain = 0.05;          // of the patches; closer ones count as equal

// Share of the current view's patches that another one has a patch for.
double overlap(const DepthView& current, const DepthView& other, const Pose& other_from_current) {
  const Eigen::Matrix3f rotation = other_from_current.linear().cast<float>();
  const Eigen::Vector3f translation = other_from_current.translation().cast<float>();
  int patches = 0, matched = 0;
  for (int row = 0; row < current.rows(); row += kSparse) {
    for (int column = 0; column < current.columns(); column += kSparse) {
      const PlanePatch& patch = current.patch(column, row);
      if (patch.weight <= 0) continue;
      ++patches;
      matched += other.at(rotation * patch.point + translation) != nullptr;
    }
  }
  return patches > 0 ? static_cast<double>(matched) / patches : 0.0;
}

}  // namespace

ReferenceViews::Neighbours ReferenceViews::around(const DepthView& current,
                                                  const Pose& world_from_camera,
                                                  const SparseMap& map) const {
  struct Candidate {
    double overlap;
    const View* view;
    Pose world_from_camera;
  };
  std::vector<Candidate> candidates;
  for (const View& view : views_) {
    if (view.keyframe >= map.keyframe_id_end()) continue;
    const Pose pose = map.world_from_keyframe(view.keyframe) * view.keyframe_from_camera;
    const double share = overlap(current, view.view, pose.inverse() * world_from_camera);
    if (share >= kMinOverlap) candidates.push_back({share, &view, pose});
  }
  // The oldest of those that overlap nearly as much as the best: registration from view to view
  // accumulates drift.
  Neighbours neighbours;
  while (!candidates.empty() && neighbours.views.size() < kComparedViews) {
    const auto best = std::ranges::max_element(candidates, {}, &Candidate::overlap);
    const double enough = best->overlap - kMinGain;
    const auto chosen =
        std::ranges::find_if(candidates, [&](const Candidate& c) { return c.overlap >= enough; });
    if (neighbours.views.empty()) neighbours.nearest = chosen->view->keyframe;
    neighbours.views.push_back({&chosen->view->view, chosen->world_from_camera});
    candidates.erase(chosen);
  }
  return neighbours;
}

void ReferenceViews::add(KeyFrameId keyframe, const Pose& keyframe_from_camera, DepthView view) {
  views_.push_back({keyframe, keyframe_from_camera, std::move(view)});
  if (views_.size() > kMaxViews) views_.pop_front();
}

}  // namespace stillpoint::orb_slam
