#include "people/figure.hpp"

#include <gtest/gtest.h>

#include "small_base.hpp"

namespace stillpoint::people {
namespace {

constexpr double kHeight = 1.8;  // m
constexpr double kDistance = 4;  // m
constexpr double kRelief = 0.07 * kHeight;

/// Stands still at x = 0.
PersonPlan standing() { return {.walk = {0, 0, kDistance, 10, 0, kDistance}, .height = kHeight}; }

class FigureTest : public ::testing::Test {
 protected:
  Layer seen(const PersonPlan& plan, double time = 0) const {
    const MaskedPhoto photo = read_photo(photo_.image, photo_.mask);
    const Figure figure(plan, cut_out(photo.bgr, photo.mask, 1), 0, 1);
    return figure.seen_from(level_camera(), rays_, time);
  }
  static cv::Rect box_of(const Layer& layer) { return cv::boundingRect(layer.alpha > 0.5); }

  testing::TemporaryFolder folder_;
  PersonPhoto photo_ = write_person(folder_);
  Rays rays_{small_camera()};
};

TEST_F(FigureTest, IsAsFarAwayAndAsTallAsPlanned) {
  const Layer layer = seen(standing());
  EXPECT_NEAR(layer.z.at<float>(60, 80), kDistance - kRelief, 0.01);  // the front of the body
  const CameraModel camera = small_camera();
  const double feet = camera.cy + camera.fy * kEyes / kDistance;
  const double head = camera.cy + camera.fy * (kEyes - kHeight) / kDistance;
  EXPECT_NEAR(box_of(layer).br().y, feet, 2);
  EXPECT_NEAR(box_of(layer).y, head, 2);
  // Its own colour, up to the outline.
  const cv::Vec3f colour = layer.bgr.at<cv::Vec3f>(60, 80);
  EXPECT_GT(colour[2], 5 * colour[0]);
}

TEST_F(FigureTest, IsNowhereRigid) {
  cv::Mat change;
  cv::absdiff(seen(standing(), 1.0).alpha, seen(standing(), 1.3).alpha, change);
  EXPECT_GT(cv::countNonZero(change > 0.1), 10);
}

TEST_F(FigureTest, WhoSitsIsSmallerAndStandsOnTheFloor) {
  PersonPlan plan = standing();
  plan.sits = {0, 6};
  const cv::Rect seated = box_of(seen(plan, 3)), standing = box_of(seen(plan, 8));
  EXPECT_NEAR(seated.br().y, standing.br().y, 2);
  EXPECT_NEAR(seated.height, 0.8 * standing.height, 0.05 * standing.height);
}

TEST_F(FigureTest, WhoIsTooNearOrBehindIsLeftOut) {
  for (const double y : {0.2, -1.0})
    EXPECT_TRUE(seen({.walk = {0, 0, y}, .height = kHeight}).box.empty()) << y;
}

}  // namespace
}  // namespace stillpoint::people
