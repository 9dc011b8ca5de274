// Earlier views that the current frame is compared with.
#pragma once

#include <vector>

#include "map_checks/depth_cells.hpp"

namespace stillpoint::map_checks {

/// How far a surface was trusted when it was seen.
enum Trust : int {
  kNotStatic = 0,  ///< dynamic, as far as was known
  kTracked = 1,    ///< static, but of a class that is not mapped
  kMapped = 2
};

/// What a tracked frame saw.
struct View {
  TrackedFrame tracked;  ///< without images
  double time = 0.0;     ///< seconds
  CellCamera camera;
  cv::Mat depth;    ///< CV_32FC1, see sample_depth
  cv::Mat bounds;   ///< CV_32FC2, see depth_bounds
  cv::Mat normals;  ///< CV_32FC3, see surface_normals
  cv::Mat trust;    ///< CV_32SC1, a Trust
  /// Where its depth fits the other views, in the frame of the camera as it was tracked.
  Pose tracked_from_depth = Pose::Identity();
  Pose world_from_camera = Pose::Identity();  ///< of the depth image, at present
};

/// `world_from_camera` is the pose that was tracked.
View make_view(const TrackedFrame& tracked);

struct MemoryOptions {
  int views = 8;           ///< kept
  double interval = 0.33;  ///< s, after which a frame is kept in any case
  double angle = 10.0;     ///< degrees, and
  double distance = 0.15;  ///< m from every view kept: then a frame is kept at once

  void visit(OptionVisitor& visitor);
};

/// A fixed number of views: dense in the recent past, increasingly sparse before, from different
/// viewpoints.
class ViewMemory {
 public:
  explicit ViewMemory(const MemoryOptions& options) : options_(options) {}

  /// Whether add() would keep it.
  bool is_new_view(const TrackedFrame& frame) const;
  void add(View view);
  /// Moves all views to their poses in `map`.
  void move_to(const SparseMap& map);
  /// Newest first.
  const std::vector<View>& views() const { return views_; }

 private:
  double novelty(const Pose& a, const Pose& b) const;
  void drop_most_redundant();

  MemoryOptions options_;
  std::vector<View> views_;  // newest first
};

}  // namespace stillpoint::map_checks
