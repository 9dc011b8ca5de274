// A camera that turns once around and a little farther, with a map that has drifted on the way, for
// tests: what is seen again has become new landmarks.
#pragma once

#include <numbers>
#include <optional>
#include <vector>

#include "orb_slam/test_world.hpp"

namespace stillpoint::orb_slam {

class RoundTrip {
 public:
  static constexpr int kKeyFrames = 44;
  static constexpr int kPerTurn = 36;  // key frames until the camera looks ahead again
  static constexpr KeyFrameId kOneTurnOn = kPerTurn;  // looks where key frame 0 looked

  explicit RoundTrip(double drift = 0.004) : drift_(drift) {
    for (int i = 0; i < kKeyFrames; ++i) views_.push_back(world_.render(truth(i)));
  }

  // On a circle of 1 m, looking outwards.
  static Pose truth(int i) {
    const double angle = 2 * std::numbers::pi * i / kPerTurn;
    return pose_at({std::sin(angle), 0.05 * std::sin(3 * angle), std::cos(angle) - 1},
                   {0, angle, 0});
  }
  Pose drifted(int i) const {
    Vector6d twist;
    twist << 1, -0.3, 0.5, 0.1, 0.6, -0.2;
    return truth(i) * exp_se3(drift_ * i * twist);
  }

  // The first `count` key frames, with ids that follow those of `before`. A point that was out of
  // sight for a while is not recognised.
  SparseMap map(int count = kKeyFrames, SparseMap before = {}) const {
    struct Known {
      LandmarkId landmark = kNoId;
      int last_seen = 0;
    };
    std::vector<Known> known(world_.points().size());
    const std::size_t first_landmark = before.landmark_id_end();
    const auto first = static_cast<KeyFrameId>(before.keyframe_id_end());
    MapEdit edit(std::move(before));
    for (int k = 0; k < count; ++k) {
      const KeyFrameId id = first + static_cast<KeyFrameId>(k);
      View view = views_[static_cast<std::size_t>(k)];
      view.world_from_camera = drifted(k);
      edit.add_keyframe(keyframe_of(view, id));
      for (std::uint32_t f = 0; f < view.point.size(); ++f) {
        Known& point = known[view.point[f]];
        const Eigen::Vector3d in_camera =
            truth(k).inverse() * world_.points()[view.point[f]].position;
        if (point.landmark == kNoId || k - point.last_seen > kPerTurn / 2)
          point.landmark = edit.add_landmark(
              {.position_in_world = drifted(k) * in_camera, .reference = id, .created_by = id});
        point.last_seen = k;
        edit.add_observation(point.landmark, {id, f});
      }
    }
    for (auto id = static_cast<LandmarkId>(first_landmark); id < edit.map().landmark_id_end(); ++id)
      refresh_landmark(edit, id);
    for (KeyFrameId id = first; id < edit.map().keyframe_id_end(); ++id)
      edit.update_covisibility(id);
    return std::move(edit).finish();
  }

  /// The point that a landmark is, by its first observation.
  std::uint32_t point_of(const SparseMap& map, LandmarkId id) const {
    const Observation& o = map.landmark(id)->observations.front();
    return views_[o.keyframe].point[o.feature];
  }
  const std::vector<View>& views() const { return views_; }
  TestWorld& world() { return world_; }

 private:
  double drift_;
  TestWorld world_{9000, 3, {{-6, -2, -7}, {6, 2, 5}}};
  std::vector<View> views_;
};

inline double worst_metres(const SparseMap& map) {
  double worst = 0;
  for (KeyFrameId id = 0; id < map.keyframe_id_end(); ++id)
    worst = std::max(
        worst, metres_between(map.world_from_keyframe(id), RoundTrip::truth(static_cast<int>(id))));
  return worst;
}

}  // namespace stillpoint::orb_slam
