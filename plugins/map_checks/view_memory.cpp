#include "map_checks/view_memory.hpp"

#include <algorithm>
#include <limits>
#include <numbers>
#include <opencv2/imgproc.hpp>

namespace stillpoint::map_checks {
namespace {

constexpr int kMinUsedWeight = 128;  // weight from which a surface was used

/// 255 in the cells whose middle pixel has enough weight.
cv::Mat used_cells(const cv::Mat& weight, cv::Size size) {
  if (weight.empty()) return {size, CV_8U, cv::Scalar(255)};
  cv::Mat cells;
  cv::resize(weight, cells, size, 0, 0, cv::INTER_NEAREST);
  return cells >= kMinUsedWeight;
}

cv::Mat trust_image(const StaticWeights& weights, cv::Size size) {
  const cv::Mat tracked = used_cells(weights.track, size);
  cv::Mat trust(size, CV_32S, cv::Scalar(kNotStatic));
  trust.setTo(kTracked, tracked);
  trust.setTo(kMapped, tracked & used_cells(weights.map, size));
  return trust;
}

}  // namespace

View make_view(const TrackedFrame& tracked) {
  const Frame& frame = *tracked.frame;
  View view{.tracked = tracked, .time = frame.time, .camera = CellCamera(*frame.camera)};
  view.depth = sample_depth(frame.depth);
  view.bounds = depth_bounds(view.depth);
  view.normals = surface_normals(view.depth, view.camera);
  view.trust = trust_image(*tracked.weights, view.depth.size());
  view.world_from_camera = tracked.world_from_camera;
  view.tracked.frame = nullptr;
  view.tracked.weights = nullptr;
  return view;
}

void MemoryOptions::visit(OptionVisitor& v) {
  v("views", views, {.min = 2, .max = 100, .help = "number of earlier frames kept"});
  v("interval", interval,
    {.min = 0,
     .max = 60,
     .unit = "s",
     .help = "a frame is kept at the latest this long after the last kept one"});
  v("angle", angle,
    {.min = 0.1,
     .max = 180,
     .unit = "degrees",
     .help =
         "change of direction at which a frame is kept at once; counts together with distance"});
  v("distance", distance,
    {.min = 0.001,
     .max = 10,
     .unit = "m",
     .help = "change of position at which a frame is kept at once; counts together with angle"});
}

void ViewMemory::add(View view) {
  if (views_.size() == static_cast<std::size_t>(options_.views)) drop_most_redundant();
  views_.insert(views_.begin(), std::move(view));
}

void ViewMemory::move_to(const SparseMap& map) {
  for (View& view : views_)
    view.world_from_camera = view.tracked.pose_in(map) * view.tracked_from_depth;
}

bool ViewMemory::is_new_view(const TrackedFrame& frame) const {
  if (views_.empty()) return true;
  if (frame.frame->time - views_.front().time >= options_.interval) return true;
  return std::ranges::all_of(views_, [&](const View& view) {
    return novelty(view.world_from_camera, frame.world_from_camera) >= 1;
  });
}

/// Distance of two viewpoints; from 1 on they count as different.
double ViewMemory::novelty(const Pose& a, const Pose& b) const {
  const Pose apart = a.inverse() * b;
  const double degrees = rotation_angle(apart) * 180 / std::numbers::pi;
  return degrees / options_.angle + apart.translation().norm() / options_.distance;
}

/// The most redundant one: its neighbour in time is close to it, relative to its age, and has
/// nearly the same viewpoint.
void ViewMemory::drop_most_redundant() {
  std::size_t spare = 1;
  double least = std::numeric_limits<double>::max();
  const double now = views_.front().time;
  for (std::size_t i = 1; i + 1 < views_.size(); ++i) {
    const View& view = views_[i];
    const double age = now - view.time + options_.interval;
    for (const std::size_t j : {i - 1, i + 1}) {
      const View& other = views_[j];
      const double difference = std::abs(view.time - other.time) / age +
                                novelty(view.world_from_camera, other.world_from_camera);
      if (difference >= least) continue;
      least = difference;
      spare = i;
    }
  }
  views_.erase(views_.begin() + static_cast<std::ptrdiff_t>(spare));
}

}  // namespace stillpoint::map_checks
