#include "orb_slam/observed_frame.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "orb_slam/test_world.hpp"

namespace stillpoint::orb_slam {
namespace {

Features features_at(std::initializer_list<cv::Point2f> pixels) {
  Features features;
  for (const cv::Point2f p : pixels) features.keypoints.emplace_back(p, 31.f);
  features.descriptors.resize(features.size());
  return features;
}

// Nothing measured but in what a test paints.
std::shared_ptr<Frame> frame_without_depth() {
  auto frame = std::make_shared<Frame>();
  frame->camera = std::make_shared<Camera>();
  frame->depth = cv::Mat::zeros(480, 640, CV_32FC1);
  return frame;
}

TEST(Observe, SamplesDepthAtTheNearestPixel) {
  const auto frame = frame_without_depth();
  frame->depth.at<float>(200, 100) = 1.5f;
  frame->depth.at<float>(301, 101) = 2.5f;
  const ObservedFrame seen =
      observe(frame, features_at({{100.4f, 199.6f}, {100.6f, 300.6f}, {300, 300}}));
  EXPECT_THAT(seen.features->depth, testing::ElementsAre(1.5f, 2.5f, 0.0f));
  EXPECT_EQ(seen.matched(), 0);
  for (std::uint32_t i = 0; i < 3; ++i) EXPECT_TRUE(seen.usable(i) && seen.free(i));
}

TEST(Observe, NoDepthBesideADepthEdge) {
  const auto frame = frame_without_depth();
  frame->depth.colRange(0, 320) = 1.0f;
  frame->depth.colRange(320, 640) = 2.0f;
  const ObservedFrame seen =
      observe(frame, features_at({{300, 100}, {319, 100}, {320, 100}, {340, 100}}));
  EXPECT_THAT(seen.features->depth, testing::ElementsAre(1.0f, 0.0f, 0.0f, 2.0f));
}

TEST(Observe, SlantedSurfacesKeepTheirDepth) {
  const auto frame = frame_without_depth();
  for (int u = 0; u < 640; ++u) frame->depth.col(u) = 1.0f + 0.003f * static_cast<float>(u);
  const ObservedFrame seen = observe(frame, features_at({{50, 100}, {0, 0}, {639, 479}}));
  for (const float depth : seen.features->depth) EXPECT_GT(depth, 0);
}

// 1.5 standard deviations up and down, pixel by pixel: 5 % of the depth between two pixels.
TEST(Observe, NoiseOfFarSurfacesIsNoDepthEdge) {
  const auto frame = frame_without_depth();
  const double sigma = frame->camera->surface_noise * 8 * 8;
  for (int v = 0; v < 480; ++v)
    for (int u = 0; u < 640; ++u)
      frame->depth.at<float>(v, u) = static_cast<float>(8 + ((u + v) % 2 ? 1.5 : -1.5) * sigma);
  const ObservedFrame seen = observe(frame, features_at({{300, 100}, {320, 200}}));
  for (const float depth : seen.features->depth) EXPECT_NEAR(depth, 8, 1.6 * sigma);
}

TEST(ObservedFrame, WeightsDecideWhoMayBeUsed) {
  TestWorld world;
  ObservedFrame frame = observed(world.render(Pose::Identity()));
  StaticWeights weights;
  weights.track = cv::Mat(480, 640, CV_8UC1, cv::Scalar(255));
  weights.track.colRange(0, 320) = 0;
  weights.map = cv::Mat(480, 640, CV_8UC1, cv::Scalar(77));
  frame.set_weights(weights);
  for (std::uint32_t i = 0; i < frame.features->size(); ++i) {
    EXPECT_EQ(frame.usable(i), cvRound(frame.features->keypoints[i].pt.x) >= 320);
    EXPECT_EQ(frame.free(i), frame.usable(i));
    EXPECT_EQ(frame.map_weights[i], 77);
  }
  frame.set_weights({});  // empty images: everything is static
  EXPECT_THAT(frame.track_weights, testing::Each(255));
  EXPECT_THAT(frame.map_weights, testing::Each(255));
}

TEST(ObservedFrame, BookkeepingOfLandmarks) {
  TestWorld world;
  ObservedFrame frame = observed(world.render(Pose::Identity()));
  frame.assign(std::vector<Match>{{.id = 5, .feature = 0}, {.id = 6, .feature = 2}});
  EXPECT_EQ(frame.matched(), 2);
  EXPECT_FALSE(frame.free(0));
  EXPECT_TRUE(frame.free(1));
  frame.outlier[2] = true;
  frame.drop_outliers();
  EXPECT_EQ(frame.landmarks[0], 5u);
  EXPECT_EQ(frame.landmarks[2], kNoId);
  EXPECT_FALSE(frame.outlier[2]);
}

class SolvePoseTest : public testing::Test {
 protected:
  void match_truth() {
    for (std::uint32_t i = 0; i < view_.point.size(); ++i)
      frame_.landmarks[i] = known_.landmark_of[view_.point[i]];
  }
  TestWorld world_;
  KnownMap known_ = known_map(world_, {world_.render(walk(0)), world_.render(walk(3))});
  View view_ = world_.render(walk(2));
  ObservedFrame frame_ = observed(view_);
};

TEST_F(SolvePoseTest, FindsThePoseFromMatchedLandmarks) {
  match_truth();
  const int inliers = solve_pose(frame_, known_.map);
  EXPECT_GT(inliers, 0.9 * frame_.matched());
  EXPECT_LT(metres_between(frame_.world_from_camera, walk(2)), 0.003);
  EXPECT_LT(radians_between(frame_.world_from_camera, walk(2)), 0.001);
}

TEST_F(SolvePoseTest, MarksWrongMatches) {
  match_truth();
  for (std::uint32_t i = 0; i < 40; ++i) std::swap(frame_.landmarks[i], frame_.landmarks[i + 100]);
  solve_pose(frame_, known_.map);
  int marked = 0, wrong = 0;
  for (std::uint32_t i = 0; i < frame_.landmarks.size(); ++i) {
    if (frame_.landmarks[i] == kNoId || known_.point[frame_.landmarks[i]] == view_.point[i])
      continue;
    ++wrong;
    marked += frame_.outlier[i];
  }
  EXPECT_GT(wrong, 40);
  EXPECT_GE(marked, wrong - 2);
  EXPECT_LT(metres_between(frame_.world_from_camera, walk(2)), 0.003);
}

TEST_F(SolvePoseTest, LandmarksThatAreGoneAreLeftOut) {
  match_truth();
  MapEdit edit(known_.map);
  for (LandmarkId id = 0; id < known_.map.landmark_id_end(); id += 2) edit.remove_landmark(id);
  const SparseMap map = std::move(edit).finish();
  const int inliers = solve_pose(frame_, map);
  EXPECT_GT(inliers, 0.4 * frame_.matched());
  EXPECT_LE(inliers, 0.6 * frame_.matched());
  EXPECT_LT(metres_between(frame_.world_from_camera, walk(2)), 0.004);
}

// The left half of the image is a person whose landmarks a key frame created, and who has moved by
// 3 cm since.
class ProbationTest : public SolvePoseTest {
 protected:
  ProbationTest() {
    match_truth();
    MapEdit edit(known_.map);
    edit.keyframe(0).time = edit.map().keyframe(1)->time - 10;
    for (LandmarkId id = 0; id < known_.map.landmark_id_end(); ++id) {
      const bool on_person = known_.map.landmark(id)->position_in_world.x() < 0;
      edit.landmark(id).created_by = on_person ? 1 : 0;
      if (on_person) edit.landmark(id).position_in_world += Eigen::Vector3d(0.02, 0.0, 0.02);
    }
    map_ = std::move(edit).finish();
  }

  double error_at(double seconds_since_creation, double probation, KeyFrameId first_keyframe = 0) {
    auto frame = std::make_shared<Frame>(*frame_.frame);
    frame->time = map_.keyframe(1)->time + seconds_since_creation;
    frame_.frame = std::move(frame);
    frame_.world_from_camera = walk(2);
    solve_pose(frame_, map_, probation, first_keyframe);
    return metres_between(frame_.world_from_camera, walk(2));
  }

  SparseMap map_;
};

TEST_F(ProbationTest, CountLittleAtFirst) {
  EXPECT_GT(error_at(0.05, 0.0), 0.02);
  EXPECT_LT(error_at(0.05, 1.0), 0.01);
}

TEST_F(ProbationTest, CountInFullOnceTheyAreProven) {
  EXPECT_EQ(error_at(2.0, 1.0), error_at(2.0, 0.0));
}

TEST_F(ProbationTest, OfAnotherRecordingAreNone) {
  EXPECT_EQ(error_at(0.05, 1.0, 2), error_at(0.05, 0.0));
  EXPECT_EQ(error_at(-20.0, 1.0), error_at(-20.0, 0.0));
}

TEST_F(SolvePoseTest, WithoutMatchesThePoseStays) {
  frame_.world_from_camera = walk(7);
  EXPECT_EQ(solve_pose(frame_, known_.map), 0);
  EXPECT_TRUE(frame_.world_from_camera.isApprox(walk(7)));
}

}  // namespace
}  // namespace stillpoint::orb_slam
