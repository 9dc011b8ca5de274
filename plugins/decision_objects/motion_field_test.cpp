// How far the evidence of a point reaches.
#include "decision_objects/motion_field.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <opencv2/core.hpp>

#include "stillpoint/support/pixel_scale.hpp"

namespace stillpoint::decision_objects {
namespace {

constexpr float kNearSurface = 1.0F;  // m; the reach of 0.2 m is more than the limit there
const cv::Size kImageSizes[] = {{320, 240}, {640, 480}, {1280, 720}};

/// Log-odds beside a moving point in the middle of a plain surface, px of 640 x 480 to its right.
class ReachOfAPoint {
 public:
  ReachOfAPoint(cv::Size size, float depth) : size_(size) {
    Frame frame;
    frame.depth = cv::Mat(size, CV_32FC1, cv::Scalar(depth));
    Camera camera{.width = size.width, .height = size.height};
    camera.fx = camera.fy = 535 * pixel_scale(size);
    frame.camera = std::make_shared<const Camera>(camera);
    const cv::Point2f middle(static_cast<float>(size.width) / 2,
                             static_cast<float>(size.height) / 2);
    field_.update(frame, {.points = {{middle, middle, 5.0F, true}}, .reliable = true});
  }
  float at(double right) const {
    const int x = size_.width / 2 + static_cast<int>(right * pixel_scale(size_));
    return field_.log_odds().at<float>(size_.height / 2 / MotionField::kCell,
                                       x / MotionField::kCell);
  }

 private:
  cv::Size size_;
  MotionField field_{MotionFieldOptions{}};
};

TEST(MotionField, OnANearSurfaceItIsTheSameShareOfImagesOfAnySize) {
  for (const cv::Size& size : kImageSizes) {
    SCOPED_TRACE(size.width);
    const ReachOfAPoint reach(size, kNearSurface);
    EXPECT_GT(reach.at(72), 0);
    EXPECT_EQ(reach.at(92), 0);
  }
}

TEST(MotionField, WithoutDepthItIsTheSameShareOfImagesOfAnySize) {
  for (const cv::Size& size : kImageSizes) {
    SCOPED_TRACE(size.width);
    const ReachOfAPoint reach(size, 0);
    EXPECT_GT(reach.at(8), 0);
    EXPECT_EQ(reach.at(16), 0);
  }
}

TEST(MotionField, OnAFarSurfaceItIsInMetres) {
  for (const cv::Size& size : kImageSizes) {
    SCOPED_TRACE(size.width);
    const ReachOfAPoint reach(size, 4.0F);  // 26.75 px
    EXPECT_GT(reach.at(20), 0);
    EXPECT_EQ(reach.at(32), 0);
  }
}

}  // namespace
}  // namespace stillpoint::decision_objects
