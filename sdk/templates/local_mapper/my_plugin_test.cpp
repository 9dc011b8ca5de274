#include "my_plugin.hpp"

#include <gtest/gtest.h>

#include <stillpoint/testing/test_recording.hpp>
#include <string>
#include <utility>

namespace plugins::my_plugin {
namespace {

using stillpoint::SparseMap;
using stillpoint::testing::TestRecording;

const TestRecording& recording() {
  static const TestRecording recording({.frames = 2});
  return recording;
}

std::string fault_of(const SparseMap& map) { return map.check().value_or("none"); }

TEST(MyPlugin, MakesALandmarkOfEachStaticFeatureWithDepth) {
  MyPlugin mapper(MyPlugin::Options{});
  const stillpoint::KeyFrame keyframe = recording().keyframe(0, 0);
  std::size_t wanted = 0;
  for (std::size_t i = 0; i < keyframe.features->size(); ++i)
    wanted += keyframe.features->depth[i] > 0 && keyframe.features->depth[i] <= 5 &&
              keyframe.map_weights[i] > 0;
  ASSERT_GT(wanted, 100u);
  const SparseMap map = mapper.insert({}, keyframe);
  EXPECT_EQ(map.landmark_count(), wanted);
  EXPECT_EQ(fault_of(map), "none");
  // Each lies where its feature is seen.
  const stillpoint::Landmark& landmark = *map.landmark(0);
  const stillpoint::Observation& seen = landmark.observations.at(0);
  const Eigen::Vector2d pixel =
      keyframe.camera->project(keyframe.world_from_camera.inverse() * landmark.position_in_world);
  EXPECT_NEAR(pixel.x(), keyframe.features->keypoints[seen.feature].pt.x, 1e-3);
  EXPECT_NEAR(pixel.y(), keyframe.features->keypoints[seen.feature].pt.y, 1e-3);
}

TEST(MyPlugin, RemovesLandmarksThatAreNotFoundAgain) {
  MyPlugin mapper(MyPlugin::Options{});
  SparseMap map = mapper.refine(mapper.insert({}, recording().keyframe(0, 0)), 0, {});
  const std::size_t before = map.landmark_count();
  stillpoint::KeyFrame second = recording().keyframe(1, 1);
  second.features = std::make_shared<const stillpoint::Features>();
  second.track_weights.clear();
  second.map_weights.clear();
  second.landmarks.clear();
  second.evidence = {{.landmark = 0, .visible = 9}, {.landmark = 1, .visible = 9, .found = 9}};
  map = mapper.insert(std::move(map), second);

  std::stop_source end_early;
  end_early.request_stop();
  map = mapper.refine(std::move(map), 1, end_early.get_token());
  EXPECT_EQ(map.landmark_count(), before);
  map = mapper.refine(std::move(map), 1, {});
  EXPECT_EQ(map.landmark(0), nullptr);
  EXPECT_NE(map.landmark(1), nullptr);
  EXPECT_EQ(map.landmark_count(), before - 1);
  EXPECT_EQ(fault_of(map), "none");
}

TEST(MyPlugin, KeyFramesWithoutFeaturesAreKept) {
  MyPlugin mapper(MyPlugin::Options{});
  stillpoint::KeyFrame empty = recording().keyframe(0, 0);
  empty.features = std::make_shared<const stillpoint::Features>();
  empty.track_weights.clear();
  empty.map_weights.clear();
  empty.landmarks.clear();
  const SparseMap map = mapper.refine(mapper.insert({}, empty), 0, {});
  EXPECT_EQ(map.keyframe_count(), 1u);
  EXPECT_EQ(map.landmark_count(), 0u);
}

}  // namespace
}  // namespace plugins::my_plugin
