#include "my_plugin.hpp"

#include <gtest/gtest.h>

#include <stillpoint/testing/test_recording.hpp>
#include <utility>

namespace plugins::my_plugin {
namespace {

using stillpoint::Pose;
using stillpoint::testing::TestRecording;

constexpr stillpoint::KeyFrameId kLatest = 10;

const TestRecording& recording() {
  static const TestRecording recording({.frames = 3, .metres_per_second = 0.2});
  return recording;
}

/// Key frames without features lie between two that see the same; the last has drifted.
stillpoint::SparseMap map_with_drift(const Eigen::Vector3d& drift) {
  stillpoint::MapEdit edit{stillpoint::SparseMap()};
  for (stillpoint::KeyFrameId id = 0; id <= kLatest; ++id) {
    stillpoint::KeyFrame keyframe = recording().keyframe(id == kLatest ? 2 : 0, id);
    if (id > 0 && id < kLatest) {
      keyframe.features = std::make_shared<const stillpoint::Features>();
      keyframe.track_weights.clear();
      keyframe.map_weights.clear();
      keyframe.landmarks.clear();
    }
    keyframe.world_from_camera.translation() += drift * id / kLatest;
    edit.add_keyframe(std::move(keyframe));
    edit.update_covisibility(id);
  }
  return std::move(edit).finish();
}

MyPlugin closer() { return {MyPlugin::Options{}, stillpoint::testing::test_context()}; }

TEST(MyPlugin, CorrectsTheDriftOfALoop) {
  const auto map = map_with_drift({0.2, 0, 0.1});
  const auto correction = closer().close(map, kLatest, {});
  ASSERT_TRUE(correction);
  const auto corrected = stillpoint::apply(*correction, map);
  const Pose end = corrected.world_from_keyframe(kLatest);
  const Pose middle = corrected.world_from_keyframe(kLatest / 2);
  EXPECT_LT((recording().world_from_camera(2).inverse() * end).translation().norm(), 0.02);
  EXPECT_LT((recording().world_from_camera(0).inverse() * middle).translation().norm(), 0.02);
  EXPECT_FALSE(corrected.check());
}

TEST(MyPlugin, ClosesNoLoopWithoutDrift) {
  EXPECT_FALSE(closer().close(map_with_drift({0, 0, 0}), kLatest, {}));
}

TEST(MyPlugin, ClosesNoLoopThatIsTooShortOrOfAKeyFrameThatIsGone) {
  const auto map = map_with_drift({0.2, 0, 0.1});
  EXPECT_FALSE(closer().close(map, kLatest - 1, {}));
  EXPECT_FALSE(closer().close(map, kLatest + 1, {}));
  EXPECT_FALSE(closer().close({}, 0, {}));
}

TEST(MyPlugin, EndsWithoutALoopWhenItIsToStop) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_FALSE(closer().close(map_with_drift({0.2, 0, 0.1}), kLatest, stop.get_token()));
}

}  // namespace
}  // namespace plugins::my_plugin
