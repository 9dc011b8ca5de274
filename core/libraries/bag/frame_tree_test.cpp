#include "bag/frame_tree.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/bag_writer.hpp"
#include "support/error_text.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint::bag {
namespace {

using stillpoint::testing::BagBytes;
using stillpoint::testing::error_text;
using stillpoint::testing::transforms_message;

Pose pose(double x, double turn) {
  Pose result = exp_se3((Vector6d() << 0, 0, 0, 0.1, turn, -0.2).finished());
  result.translation() = Eigen::Vector3d(x, 0.5, -x);
  return result;
}

class FrameTreeTest : public ::testing::Test {
 protected:
  void add(const std::string& topic, const std::vector<TransformMessage>& transforms) {
    writer_->add(topic, "tf2_msgs/TFMessage", ++time_,
                 transforms_message(Serialisation::kCdr, transforms));
  }
  void add_damaged() {
    writer_->add("/tf", "tf2_msgs/TFMessage", ++time_, BagBytes{0, 1, 0, 0, 9});
  }
  FrameTree tree() {
    writer_->finish();
    return FrameTree(*open_bag(file_));
  }
  static std::string refusal(const FrameTree& tree, const char* target, const char* source) {
    return error_text(Fault::kUsage, [&] { tree.target_from_source(target, source); });
  }

  const stillpoint::testing::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_.path() / "a.mcap";
  const std::unique_ptr<stillpoint::testing::BagWriter> writer_ =
      stillpoint::testing::make_bag_writer(file_, {"mcap", "zstd"});
  std::int64_t time_ = 0;
};

// As of a RealSense: both cameras hang from the one body, which itself moves.
TEST_F(FrameTreeTest, ConnectsFramesOverTheOneAboveBoth) {
  add_damaged();
  add("/tf", {{"world", "body", pose(0, 0)}});
  add("/tf_static", {{"body", "depth", pose(0.1, 0.2)}, {"depth", "depth_optical", pose(0.2, 1)}});
  add("/tf_static", {{"body", "color", pose(0.3, -0.1)}});
  add("/tf", {{"world", "body", pose(1, 1)}});
  const FrameTree frames = tree();
  const Pose color_from_depth = pose(0.3, -0.1).inverse() * pose(0.1, 0.2) * pose(0.2, 1);
  EXPECT_TRUE(frames.target_from_source("color", "depth_optical").isApprox(color_from_depth));
  EXPECT_TRUE(
      frames.target_from_source("depth_optical", "color").isApprox(color_from_depth.inverse()));
  EXPECT_TRUE(frames.target_from_source("body", "depth").isApprox(pose(0.1, 0.2)));
  EXPECT_TRUE(frames.target_from_source("color", "color").isApprox(Pose::Identity()));
}

TEST_F(FrameTreeTest, TakesRepeatedTransformsForStill) {
  for (int i = 0; i < 3; ++i) add("/tf", {{"color", "depth", pose(0.1, 0.2)}});
  EXPECT_TRUE(tree().target_from_source("color", "depth").isApprox(pose(0.1, 0.2)));
}

TEST_F(FrameTreeTest, RefusesFramesThatMoveAgainstEachOther) {
  add("/tf_static", {{"head", "color", pose(0, 0)}, {"body", "depth", pose(0, 0)}});
  add("/tf", {{"body", "head", pose(0, 0)}});
  add("/tf", {{"body", "head", pose(0, 0.1)}});
  EXPECT_EQ(refusal(tree(), "color", "depth"), "by tf, 'depth' moves against 'color'");
}

TEST_F(FrameTreeTest, RefusesFramesThatAreNotConnected) {
  add("/tf_static", {{"a", "color", pose(0, 0)}, {"b", "depth", pose(0, 0)}});
  add("/tf_static", {{"x", "y", pose(0, 0)}, {"y", "x", pose(0, 0)}});  // a circle
  const FrameTree frames = tree();
  EXPECT_EQ(refusal(frames, "color", "depth"), "tf does not say how 'depth' lies to 'color'");
  EXPECT_EQ(refusal(frames, "color", "x"), "tf does not say how 'x' lies to 'color'");
}

}  // namespace
}  // namespace stillpoint::bag
