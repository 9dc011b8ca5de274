#include "stillpoint/support/rectifier.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "stillpoint/error.hpp"

namespace stillpoint {
namespace {

CameraModel fr1() {
  return {.name = "fr1",
          .width = 640,
          .height = 480,
          .fx = 517.306408,
          .fy = 516.469215,
          .cx = 318.643040,
          .cy = 255.313989,
          .distortion = {0.262383, -0.953104, -0.005358, 0.002628, 1.163314}};
}

/// Where the recorded pixel (u, v) lies in the rectified image.
cv::Point2d rectified_position(const CameraModel& model, double u, double v) {
  const cv::Matx33d matrix(model.fx, 0, model.cx, 0, model.fy, model.cy, 0, 0, 1);
  std::vector<cv::Point2d> in{{u, v}}, out;
  cv::undistortPoints(in, out, matrix, model.distortion, cv::noArray(), matrix,
                      {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 50, 1e-12});
  const cv::Point2d corner =
      model.crop.empty() ? cv::Point2d() : cv::Point2d(model.crop[0], model.crop[1]);
  return out[0] - corner;
}

cv::Point2d centre_of_brightness(const cv::Mat& bgr) {
  cv::Mat gray;
  cv::cvtColor(bgr, gray, cv::COLOR_BGR2GRAY);
  const cv::Moments moments = cv::moments(gray);
  return {moments.m10 / moments.m00, moments.m01 / moments.m00};
}

void expect_blobs_land_where_they_should(const CameraModel& model) {
  const Rectifier rectifier(model);
  for (const int u : {120, 320, 500})
    for (const int v : {100, 240, 400}) {
      cv::Mat spot(480, 640, CV_8UC3, cv::Scalar::all(0));
      cv::circle(spot, {u, v}, 3, cv::Scalar::all(255), cv::FILLED);
      const cv::Point2d expected = rectified_position(model, u, v);
      const cv::Point2d seen = centre_of_brightness(rectifier.color(spot));
      EXPECT_NEAR(seen.x, expected.x, 0.1) << u << ", " << v;
      EXPECT_NEAR(seen.y, expected.y, 0.1) << u << ", " << v;
    }
}

TEST(Rectifier, MovesColourAsUndistortPointsDoes) { expect_blobs_land_where_they_should(fr1()); }

TEST(Rectifier, CropsAfterUndistorting) {
  CameraModel model = fr1();
  model.crop = {20, 30, 560, 420};
  expect_blobs_land_where_they_should(model);
  const Rectifier rectifier(model);
  EXPECT_EQ(rectifier.color(cv::Mat(480, 640, CV_8UC3)).size(), cv::Size(560, 420));
  EXPECT_EQ(rectifier.depth(cv::Mat(480, 640, CV_16UC1)).size(), cv::Size(560, 420));
  EXPECT_EQ(rectifier.camera().cx, model.cx - 20);
}

TEST(Rectifier, TakesTheNearestDepthAndKeepsHoles) {
  const CameraModel model = fr1();
  cv::Mat raw(480, 640, CV_16UC1);
  for (int y = 0; y < 480; ++y)
    for (int x = 0; x < 640; ++x)
      raw.at<std::uint16_t>(y, x) = static_cast<std::uint16_t>((x / 8 + y / 8) % 2 ? 5000 : 20000);
  raw(cv::Rect(300, 200, 40, 40)) = 0;
  const cv::Mat metres = Rectifier(model).depth(raw);
  const cv::Matx33d k(model.fx, 0, model.cx, 0, model.fy, model.cy, 0, 0, 1);
  cv::Mat map_x, map_y;
  cv::initUndistortRectifyMap(k, model.distortion, cv::noArray(), k, raw.size(), CV_32FC1, map_x,
                              map_y);
  for (int y = 0; y < 480; ++y)
    for (int x = 0; x < 640; ++x) {
      const cv::Point from(cvRound(map_x.at<float>(y, x)), cvRound(map_y.at<float>(y, x)));
      const bool inside = cv::Rect(0, 0, 640, 480).contains(from);
      const float expected =
          inside ? static_cast<float>(raw.at<std::uint16_t>(from)) / 5000.f : 0.f;
      ASSERT_EQ(metres.at<float>(y, x), expected) << x << ", " << y;
    }
}

TEST(Rectifier, ConvertsEveryDepthValueExactly) {
  CameraModel model{.width = 256, .height = 256};
  model.min_depth = 0.5;
  model.max_depth = 8.0;
  cv::Mat raw(256, 256, CV_16UC1);
  for (int i = 0; i < 65536; ++i)
    raw.at<std::uint16_t>(i / 256, i % 256) = static_cast<std::uint16_t>(i);
  const cv::Mat metres = Rectifier(model).depth(raw);
  for (int i = 0; i < 65536; ++i)
    ASSERT_EQ(metres.at<float>(i / 256, i % 256),
              i >= 2500 && i <= 40000 ? static_cast<float>(i) / 5000.f : 0.f);
}

TEST(Rectifier, AcceptsNoLowerLimitAndFactorsBeyondSixteenBits) {
  CameraModel model{.width = 16, .height = 16, .depth_factor = 100000.0};
  model.min_depth = 0.0;
  const cv::Mat metres = Rectifier(model).depth(cv::Mat(16, 16, CV_16UC1, cv::Scalar(65535)));
  EXPECT_EQ(metres.at<float>(0, 0), 65535.f / 100000.f);
  EXPECT_EQ(cv::countNonZero(Rectifier(model).depth(cv::Mat::zeros(16, 16, CV_16UC1))), 0);
}

TEST(Rectifier, TakesDepthInMetresLikeRawDepth) {
  for (CameraModel model : {fr1(), CameraModel{.name = "ideal"}}) {
    model.crop = {20, 30, 560, 420};
    cv::Mat raw(480, 640, CV_16UC1), metres(480, 640, CV_32FC1);
    cv::randu(raw, 0, 65536);
    for (int y = 0; y < 480; ++y)
      for (int x = 0; x < 640; ++x)
        metres.at<float>(y, x) = static_cast<float>(raw.at<std::uint16_t>(y, x)) / 5000.f;
    metres.at<float>(200, 300) = std::numeric_limits<float>::quiet_NaN();
    raw.at<std::uint16_t>(200, 300) = 0;
    const Rectifier rectifier(model);
    EXPECT_EQ(cv::norm(rectifier.depth(raw), rectifier.depth(metres), cv::NORM_INF), 0);
  }
}

TEST(Rectifier, MakesWholeFrames) {
  const Rectifier rectifier(fr1());
  cv::Mat bgr(480, 640, CV_8UC3), depth(480, 640, CV_16UC1, cv::Scalar(5000));
  cv::randu(bgr, 0, 256);
  const Frame frame = rectifier.frame(3.5, bgr, depth);
  EXPECT_EQ(frame.time, 3.5);
  EXPECT_EQ(frame.gray.size(), frame.bgr.size());
  EXPECT_EQ(frame.depth.at<float>(240, 320), 1.f);
  EXPECT_EQ(frame.camera->fx, fr1().fx);
}

void expect_fault(const std::function<void()>& call, Fault fault, const std::string& message) {
  try {
    call();
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), fault);
    EXPECT_EQ(error.what(), message);
  }
}

TEST(Rectifier, RefusesImagesOfAnotherSizeOrType) {
  const Rectifier rectifier(fr1());
  const cv::Mat bgr(480, 640, CV_8UC3), depth(480, 640, CV_16UC1);
  expect_fault([&] { rectifier.frame(0, cv::Mat(240, 320, CV_8UC3), depth); }, Fault::kData,
               "the colour image has 320 x 240 pixels, but camera 'fr1' has 640 x 480; choose the "
               "camera of these images");
  expect_fault([&] { rectifier.frame(0, cv::Mat(), depth); }, Fault::kData,
               "the colour image is empty; look whether its file could be read, or what the driver "
               "gave");
  expect_fault([&] { rectifier.frame(0, bgr, cv::Mat(480, 640, CV_64FC1)); }, Fault::kData,
               "the depth image is of CV_64FC1; it must be of CV_16UC1");
}

TEST(Rectifier, RefusesCamerasThatAreNone) {
  CameraModel model = fr1();
  model.crop = {600, 0, 100, 100};
  expect_fault([&] { Rectifier{model}; }, Fault::kUsage,
               "camera 'fr1': crop takes x, y, width, height within the image, at least 16 x 16");
  model = fr1();
  model.fx = 0;
  expect_fault([&] { Rectifier{model}; }, Fault::kUsage, "camera 'fr1': fx = 0 is not at least 1");
  model.fx = std::numeric_limits<double>::quiet_NaN();
  expect_fault([&] { Rectifier{model}; }, Fault::kUsage, "camera 'fr1': fx = nan is not finite");
}

// What the limits of a camera's options let through must not read outside of the image.
TEST(Rectifier, TakesTheLargestValuesOfACamera) {
  const cv::Mat bgr(48, 64, CV_8UC3, cv::Scalar::all(200));
  const cv::Mat depth(48, 64, CV_16UC1, cv::Scalar(5000));
  for (const double k : {-1e6, 1e6})
    for (const double focal : {1.0, 1e6})
      for (const double centre : {-1e6, 1e6})
        for (const double factor : {1e-6, 1e9}) {
          const Rectifier rectifier(CameraModel{.width = 64,
                                                .height = 48,
                                                .fx = focal,
                                                .fy = focal,
                                                .cx = centre,
                                                .cy = centre,
                                                .distortion = {k, k, k, k, k},
                                                .depth_factor = factor,
                                                .min_depth = 0.0,
                                                .max_depth = 1e6,
                                                .depth_noise = 100,
                                                .surface_noise = 100});
          const Frame frame = rectifier.frame(0, bgr, depth);
          EXPECT_EQ(frame.bgr.size(), bgr.size());
          EXPECT_EQ(frame.depth.size(), depth.size());
          EXPECT_TRUE(cv::checkRange(frame.depth, true, nullptr, 0.0, 1e6 + 1));
        }
}

TEST(Rectifier, RefusesValuesBeyondThoseOfAnyCamera) {
  const auto expect_refused = [](const CameraModel& model) {
    try {
      Rectifier{model};
      ADD_FAILURE() << "taken";
    } catch (const Error& error) {
      EXPECT_EQ(error.fault(), Fault::kUsage);
      EXPECT_TRUE(std::string(error.what()).starts_with("camera 'fr1': ")) << error.what();
    }
  };
  const auto refused = [&](auto CameraModel::*member, auto value) {
    CameraModel model = fr1();
    model.*member = value;
    expect_refused(model);
  };
  for (const double value : {1e308, -1e308}) {
    for (const auto member :
         {&CameraModel::fx, &CameraModel::fy, &CameraModel::cx, &CameraModel::cy,
          &CameraModel::depth_factor, &CameraModel::max_depth, &CameraModel::min_depth,
          &CameraModel::depth_noise, &CameraModel::surface_noise})
      refused(member, value);
    CameraModel model = fr1();
    model.distortion[2] = value;
    expect_refused(model);
    model = fr1();
    model.crop = {0, 0, value, value};
    expect_refused(model);
  }
  for (const int value : {0, 2'000'000'000}) {
    refused(&CameraModel::width, value);
    refused(&CameraModel::height, value);
  }
}

TEST(Rectifier, LeavesImagesOfAnIdealCameraAlone) {
  CameraModel model{.distortion = {0, 0, 0, 0, 0}};
  cv::Mat image(480, 640, CV_8UC3);
  cv::randu(image, 0, 256);
  EXPECT_EQ(cv::norm(Rectifier(model).color(image), image, cv::NORM_INF), 0);
}

}  // namespace
}  // namespace stillpoint
