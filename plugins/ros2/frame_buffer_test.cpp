#include "ros2/frame_buffer.hpp"

#include <gtest/gtest.h>

namespace stillpoint::ros2 {
namespace {

Pose at(double x, double y, double z) {
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(x, y, z);
  return pose;
}

/// At `time` seconds of this century.
bag::TransformMessage link(double time, const std::string& parent, const std::string& child,
                           const Pose& parent_from_child) {
  return {.parent = parent,
          .child = child,
          .parent_from_child = parent_from_child,
          .stamp = 1'700'000'000'000'000'000 + static_cast<std::int64_t>(time * 1e9)};
}
double stamp(double time) { return 1.7e9 + time; }

TEST(FrameBuffer, GoesUpAndDownTheTree) {
  FrameBuffer frames;
  frames.add(link(0, "base_link", "mast", at(0, 0, 1)), FrameBuffer::Topic::kTfStatic);
  Pose turned = at(0.1, 0, 0);
  turned.linear() = exp_so3({0, 0, 1.5});
  frames.add(link(0, "mast", "camera", turned), FrameBuffer::Topic::kTfStatic);
  frames.add(link(0, "base_link", "gripper", at(0.5, 0, 0.2)), FrameBuffer::Topic::kTfStatic);
  EXPECT_TRUE(
      frames.target_from_source("base_link", "camera", stamp(99))->isApprox(at(0, 0, 1) * turned));
  EXPECT_TRUE(frames.target_from_source("camera", "gripper", {})
                  ->isApprox((at(0, 0, 1) * turned).inverse() * at(0.5, 0, 0.2)));
  EXPECT_TRUE(frames.target_from_source("mast", "mast", {})->isApprox(Pose::Identity()));
  EXPECT_FALSE(frames.target_from_source("base_link", "map", {}));
}

TEST(FrameBuffer, InterpolatesAndDoesNotGuess) {
  FrameBuffer frames;
  for (const double time : {1.0, 1.1, 1.3})
    frames.add(link(time, "odom", "base_link", at(10 * time, 0, 0)), FrameBuffer::Topic::kTf);
  const auto x_at = [&](double time) -> std::optional<double> {
    const auto pose = frames.target_from_source("odom", "base_link", stamp(time));
    return pose ? std::optional(pose->translation().x()) : std::nullopt;
  };
  EXPECT_NEAR(*x_at(1.2), 12, 1e-5);
  EXPECT_NEAR(*x_at(1.3), 13, 1e-5);
  EXPECT_NEAR(*x_at(1.0), 10, 1e-5);
  EXPECT_FALSE(x_at(1.31));
  EXPECT_FALSE(x_at(0.99));
  EXPECT_NEAR(frames.target_from_source("odom", "base_link", {})->translation().x(), 13, 1e-9);
}

TEST(FrameBuffer, ForgetsAndBeginsAnew) {
  FrameBuffer frames;
  for (int second = 0; second < 30; ++second)
    frames.add(link(second, "odom", "base", at(second, 0, 0)), FrameBuffer::Topic::kTf);
  EXPECT_FALSE(frames.target_from_source("odom", "base", stamp(5)));
  EXPECT_TRUE(frames.target_from_source("odom", "base", stamp(25)));
  frames.add(link(28.5, "odom", "base", at(0, 0, 0)),
             FrameBuffer::Topic::kTf);  // overtaken by a later one
  EXPECT_NEAR(frames.target_from_source("odom", "base", stamp(28.5))->translation().x(), 28.5,
              1e-5);
  frames.add(link(1, "odom", "base", at(7, 0, 0)),
             FrameBuffer::Topic::kTf);  // a bag is played again
  EXPECT_NEAR(frames.target_from_source("odom", "base", {})->translation().x(), 7, 1e-9);
  frames.add(link(2, "earth", "base", at(8, 0, 0)), FrameBuffer::Topic::kTf);
  EXPECT_FALSE(frames.target_from_source("odom", "base", {}));
}

TEST(FrameBuffer, ACircleEnds) {
  FrameBuffer frames;
  frames.add(link(0, "a", "b", at(1, 0, 0)), FrameBuffer::Topic::kTfStatic);
  frames.add(link(0, "b", "a", at(1, 0, 0)), FrameBuffer::Topic::kTfStatic);
  EXPECT_FALSE(frames.target_from_source("c", "a", {}));
}

}  // namespace
}  // namespace stillpoint::ros2
