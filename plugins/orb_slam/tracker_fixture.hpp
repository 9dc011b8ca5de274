// A tracker and a mapper that work in turns, for tests.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <utility>
#include <vector>

#include "orb_slam/local_mapper.hpp"
#include "orb_slam/test_scene.hpp"
#include "orb_slam/test_surfaces.hpp"
#include "orb_slam/test_world.hpp"
#include "orb_slam/tracker.hpp"

namespace stillpoint::orb_slam {

// As `mode: inline` runs them.
class TrackerTest : public testing::Test {
 protected:
  TrackResult step(FramePtr frame, const StaticWeights& weights = {}) {
    const auto id = static_cast<KeyFrameId>(map_.keyframe_id_end());
    TrackResult result = tracker_.track(
        tracker_.prepare(std::move(frame)), weights, map_,
        {.next_keyframe = id, .localise_only = localise_only_, .may_begin_anew = may_begin_anew_});
    if (result.begins_anew) clear_map();
    if (result.keyframe) {
      EXPECT_EQ(result.keyframe->id, id);
      map_ = mapper_.insert(std::move(map_), *result.keyframe);
      EXPECT_EQ(map_.check(), std::nullopt);
      map_ = mapper_.refine(std::move(map_), id, {});
      EXPECT_EQ(map_.check(), std::nullopt);
    }
    return result;
  }
  TrackResult step(const Pose& pose, const StaticWeights& weights = {}) {
    return step(scene_.render(pose, next_++), weights);
  }
  void clear_map() {
    MapEdit edit(std::move(map_));
    edit.clear();
    map_ = std::move(edit).finish();
  }
  static void expect_at(const TrackResult& result, const Pose& truth, double metres = 0.006,
                        double radians = 0.003) {
    ASSERT_EQ(result.state, TrackState::kTracking);
    EXPECT_LT(metres_between(result.world_from_camera, truth), metres);
    EXPECT_LT(radians_between(result.world_from_camera, truth), radians);
  }
  void track_along(const std::function<Pose(double)>& path, int frames) {
    for (int i = 0; i < frames; ++i) {
      SCOPED_TRACE(i);
      expect_at(step(path(static_cast<double>(i) / (frames - 1))), path(1.0 * i / (frames - 1)));
    }
  }
  std::vector<Pose> anew(OrbTracker::Options options, const StaticWeights& weights = {}) {
    tracker_ = OrbTracker{options};
    mapper_ = OrbLocalMapper{OrbLocalMapper::Options{}, StageContext{}};
    map_ = {};
    next_ = 0;
    std::vector<Pose> poses;
    for (int i = 0; i < 8; ++i)
      poses.push_back(step(pose_at({0.05 * i, 0, 0}), weights).world_from_camera);
    return poses;
  }

  TestScene scene_;
  OrbTracker tracker_{OrbTracker::Options{}};
  OrbLocalMapper mapper_{OrbLocalMapper::Options{}, StageContext{}};
  SparseMap map_;
  std::uint32_t next_ = 0;
  bool localise_only_ = false;
  bool may_begin_anew_ = false;
};

}  // namespace stillpoint::orb_slam
