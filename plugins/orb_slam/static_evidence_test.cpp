#include "orb_slam/static_evidence.hpp"

#include <gtest/gtest.h>

#include "orb_slam/test_world.hpp"

namespace stillpoint::orb_slam {
namespace {

constexpr double kSeconds = 1.0 / 30;

class StaticEvidenceTest : public testing::Test {
 protected:
  // A frame that sees a wall everywhere, `relative` times as far as the landmark.
  EvidenceByLandmark evidence_with_wall(double relative, bool matched) {
    ObservedFrame frame = observed(view_);
    const double z =
        (view_.world_from_camera.inverse() * known_.map.landmark(landmark_)->position_in_world).z();
    auto image = std::make_shared<Frame>(*frame.frame);
    image->camera = view_.camera;
    image->depth =
        cv::Mat(view_.camera->height, view_.camera->width, CV_32F, cv::Scalar(relative * z));
    frame.frame = image;
    if (matched) frame.landmarks[0] = landmark_;
    EvidenceByLandmark evidence;
    add_static_evidence(frame, known_.map, std::vector{landmark_}, kSeconds, evidence);
    return evidence;
  }

  TestWorld world_;
  View view_ = world_.render(walk(0), kNoNoise);
  KnownMap known_ = known_map(world_, {view_});
  LandmarkId landmark_ = known_.landmark_of[view_.point[0]];
};

TEST_F(StaticEvidenceTest, AFoundLandmarkCountsForStatic) {
  const LandmarkEvidence e = evidence_with_wall(1.0, true).at(landmark_);
  EXPECT_EQ(e.found, 1u);
  EXPECT_EQ(e.visible, 1u);
  EXPECT_GT(e.static_log_odds, 0);
}

TEST_F(StaticEvidenceTest, ALandmarkThatIsLookedPastCountsAgainst) {
  const LandmarkEvidence e = evidence_with_wall(1.5, false).at(landmark_);
  EXPECT_EQ(e.found, 0u);
  EXPECT_LT(e.static_log_odds, 0);
}

TEST_F(StaticEvidenceTest, OccludedOrUnmeasuredTellsNothing) {
  EXPECT_FALSE(evidence_with_wall(0.5, false).contains(landmark_)) << "not even visible";
  EXPECT_EQ(evidence_with_wall(0.0, false).at(landmark_).static_log_odds, 0);
  EXPECT_EQ(evidence_with_wall(1.05, false).at(landmark_).static_log_odds, 0);
}

TEST_F(StaticEvidenceTest, CountsByTheSecond) {
  ObservedFrame seen = observed(view_);
  seen.landmarks[0] = landmark_;
  const auto after_a_second = [&](int rate) {
    EvidenceByLandmark evidence;
    for (int frame = 0; frame < rate; ++frame)
      add_static_evidence(seen, known_.map, std::vector{landmark_}, 1.0 / rate, evidence);
    return evidence.at(landmark_).static_log_odds;
  };
  EXPECT_NEAR(after_a_second(15), after_a_second(30), 1e-4);
  EXPECT_NEAR(after_a_second(60), after_a_second(30), 1e-4);
  EXPECT_LT(after_a_second(1), 0.2 * after_a_second(30)) << "one frame is no proof";
}

TEST_F(StaticEvidenceTest, WhatIsBehindTheCameraIsNotInView) {
  view_.world_from_camera = view_.world_from_camera * pose_at({0, 0, 20});
  ObservedFrame frame = observed(view_);
  frame.world_from_camera = view_.world_from_camera;
  auto image = std::make_shared<Frame>(*frame.frame);
  image->depth = cv::Mat(image->camera->height, image->camera->width, CV_32F, cv::Scalar(3));
  frame.frame = image;
  EvidenceByLandmark evidence;
  add_static_evidence(frame, known_.map, std::vector{landmark_}, kSeconds, evidence);
  EXPECT_FALSE(evidence.contains(landmark_));
  EXPECT_EQ(count_unoccluded(frame, known_.map, std::vector{landmark_}), 0);
}

// A camera at rest makes no key frame for minutes.
TEST_F(StaticEvidenceTest, WhatWasStaticForMinutesMayBeginToMove) {
  ObservedFrame seen = observed(view_);
  seen.landmarks[0] = landmark_;
  EvidenceByLandmark evidence;
  for (int frame = 0; frame < 2000; ++frame)
    add_static_evidence(seen, known_.map, std::vector{landmark_}, kSeconds, evidence);
  const Landmark& landmark = *known_.map.landmark(landmark_);
  EXPECT_FLOAT_EQ(landmark.static_log_odds + evidence.at(landmark_).static_log_odds,
                  kMaxStaticLogOdds);
  EXPECT_EQ(evidence.at(landmark_).found, 2000u);
}

}  // namespace
}  // namespace stillpoint::orb_slam
