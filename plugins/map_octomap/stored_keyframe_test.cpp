#include "map_octomap/stored_keyframe.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "semantic_octree/test_room.hpp"

namespace stillpoint::map_octomap {
namespace {

using semantic_octree::looking;
using semantic_octree::TestRoom;

TEST(StoredKeyFrame, ComesBackAsItWas) {
  DenseKeyFrame keyframe = TestRoom().render(looking({0.5, -1.0, 1.3}, 0.0), 7);
  const Pose pose = looking({0.2, -0.3, 1.33}, 1.1);
  auto weights = std::make_shared<StaticWeights>();
  weights->map = keyframe.segmentation->labels * 20;
  keyframe.weights = weights;
  for (const int stride : {1, 3}) {
    const StoredKeyFrame stored(keyframe, stride);
    const DenseKeyFrame back = stored.unpack(pose);
    EXPECT_EQ(back.id, 7U);
    EXPECT_TRUE(back.world_from_camera.isApprox(pose));
    const Camera &camera = *back.frame->camera, &original = *keyframe.frame->camera;
    ASSERT_EQ(back.frame->depth.size(), cv::Size(320 / stride, 240 / stride));
    for (int y = 0; y < back.frame->depth.rows; ++y)
      for (int x = 0; x < back.frame->depth.cols; ++x) {
        const int u = x * stride + stride / 2, v = y * stride + stride / 2;
        ASSERT_NEAR(back.frame->depth.at<float>(y, x), keyframe.frame->depth.at<float>(v, u),
                    1.1e-4);
        ASSERT_EQ(back.frame->bgr.at<cv::Vec3b>(y, x), keyframe.frame->bgr.at<cv::Vec3b>(v, u));
        ASSERT_EQ(back.segmentation->labels.at<std::uint8_t>(y, x),
                  keyframe.segmentation->labels.at<std::uint8_t>(v, u));
        ASSERT_EQ(back.weights->map.at<std::uint8_t>(y, x), weights->map.at<std::uint8_t>(v, u));
        ASSERT_TRUE(camera.unproject(x, y, 1).isApprox(original.unproject(u, v, 1), 1e-9));
      }
    EXPECT_LT(stored.bytes(), 320U * 240U * 2U / (stride * stride));
  }
  keyframe.segmentation = nullptr;
  EXPECT_TRUE(StoredKeyFrame(keyframe, 1).unpack(pose).labels().empty());
}

}  // namespace
}  // namespace stillpoint::map_octomap
