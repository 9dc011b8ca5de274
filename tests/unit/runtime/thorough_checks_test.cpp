// What `runtime.validate: full` finds besides.
#include "stillpoint/runtime/thorough_checks.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <opencv2/core.hpp>

#include "doubles.hpp"
#include "stillpoint/error.hpp"
#include "stillpoint/runtime/read_only_images.hpp"

namespace stillpoint {
namespace {

using ::testing::HasSubstr;
constexpr float kNanF = std::numeric_limits<float>::quiet_NaN();

template <class... Results>
std::string fault_of(const Results&... results) {
  try {
    check_thoroughly(results...);
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kStage);
    return error.what();
  }
  return "";
}

TEST(ThoroughChecks, Depths) {
  Frame frame = testing::make_frame(0);
  frame.depth = cv::Mat::zeros(2, 3, CV_32FC1);
  EXPECT_EQ(fault_of(frame), "");
  frame.depth.at<float>(1, 2) = kNanF;
  EXPECT_EQ(fault_of(frame), "the depth at 2, 1 is nan; 0 stands for no measurement");
  frame.depth.at<float>(1, 2) = -1;
  EXPECT_THAT(fault_of(frame), HasSubstr("the depth at 2, 1 is -1.0"));
}

TEST(ThoroughChecks, MotionAndEvidence) {
  MovingPoints moving{.points = {{}}};
  EXPECT_EQ(fault_of(moving), "");
  moving.points[0].residual = kNanF;
  EXPECT_THAT(fault_of(moving), HasSubstr("the residual of a point is no number"));
  EXPECT_EQ(fault_of(MapEvidence()), "");
  EXPECT_EQ(fault_of(MapEvidence{cv::Mat(1, 1, CV_32FC1, cv::Scalar(-7))}), "");
  EXPECT_THAT(fault_of(MapEvidence{cv::Mat(1, 1, CV_32FC1, cv::Scalar(kNanF))}),
              HasSubstr("the evidence at 0, 0 is nan"));
}

TEST(ThoroughChecks, UncertaintyOfThePose) {
  TrackResult result{.state = TrackState::kTracking, .uncertainty = PoseUncertainty()};
  EXPECT_EQ(fault_of(result), "");
  result.uncertainty->covariance(2, 2) = -1;
  EXPECT_THAT(fault_of(result), HasSubstr("the uncertainty of the pose is no covariance"));
}

TEST(ThoroughChecks, Maps) {
  MapEdit map{SparseMap()};
  KeyFrame keyframe{.id = 0};
  keyframe.features = std::make_shared<const Features>(
      Features{.keypoints = {{}}, .descriptors = {{}}, .depth = {1}});
  keyframe.landmarks = {kNoId};
  map.add_keyframe(std::move(keyframe));
  const LandmarkId landmark = map.add_landmark({});
  EXPECT_THAT(fault_of(map.map()),
              HasSubstr("the map does not hold together: landmark 0 has no observation"));
  map.add_observation(landmark, {.keyframe = 0, .feature = 0});
  map.landmark(landmark).reference = 0;
  EXPECT_EQ(fault_of(map.map()), "");
  map.landmark(landmark).position_in_world.y() = kNanF;
  EXPECT_THAT(fault_of(map.map()), HasSubstr("the position of landmark 0 is no number"));
  map.keyframe(0).world_from_camera.translation().x() = kNanF;
  EXPECT_THAT(fault_of(map.map()), HasSubstr("the pose of key frame 0 is no number"));
}

TEST(ReadOnlyImages, AreCopiesThatNobodyCanWriteTo) {
  const Frame before = testing::make_frame(0);
  const unsigned char* gray = nullptr;
  {
    const Frame frame = with_read_only_images(before);
    EXPECT_EQ(cv::countNonZero(frame.depth != before.depth), 0);
    gray = frame.gray.data;
    EXPECT_TRUE(in_read_only_image(frame.depth.data));
    EXPECT_FALSE(in_read_only_image(before.depth.data));
    const cv::Mat header = frame.gray;  // shares the image
    const cv::Mat copy = frame.gray.clone();
    EXPECT_FALSE(in_read_only_image(copy.data));
    EXPECT_DEATH(frame.gray.data[0] = 1, "");
  }
  EXPECT_FALSE(in_read_only_image(gray)) << "freed";
}

}  // namespace
}  // namespace stillpoint
