#include "people/thing.hpp"

#include <gtest/gtest.h>

#include "small_base.hpp"

namespace stillpoint::people {
namespace {

TEST(Thing, IsPutDownAndStays) {
  const ThingPlan plan{.size = {0.4, 0.4, 0.4}, .path = {1, 2, 2, 0.5, 3, 0, 2, 1.2}, .turn = 0};
  const cv::Mat picture(64, 64, CV_8UC3, cv::Scalar(10, 200, 30));
  const Thing thing(plan, {picture, picture, picture}, 0);
  const Rays rays(small_camera());
  EXPECT_EQ(thing.seen_from(level_camera(), rays, 0).z.at<float>(60, 80), 0);
  for (const double time : {3.0, 30.0}) {
    const Layer layer = thing.seen_from(level_camera(), rays, time);
    EXPECT_NEAR(layer.z.at<float>(60, 80), 1.8, 1e-6);  // its front, in the height of the eyes
    EXPECT_EQ(layer.bgr.at<cv::Vec3f>(60, 80), cv::Vec3f(10, 200, 30));
    EXPECT_NEAR(cv::boundingRect(layer.z > 0).width, 134 * 0.4 / 1.8, 1.1);
  }
}

}  // namespace
}  // namespace stillpoint::people
