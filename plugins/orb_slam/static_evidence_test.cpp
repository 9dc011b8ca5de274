#include "orb_slam/static_evidence.hpp"

#include <gtest/gtest.h>

#include "orb_slam/test_world.hpp"

namespace stillpoint::orb_slam {
namespace {

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
    add_static_evidence(frame, known_.map, std::vector{landmark_}, evidence);
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

// A camera at rest makes no key frame for minutes.
TEST_F(StaticEvidenceTest, WhatWasStaticForMinutesMayBeginToMove) {
  ObservedFrame seen = observed(view_);
  seen.landmarks[0] = landmark_;
  EvidenceByLandmark evidence;
  for (int frame = 0; frame < 2000; ++frame)
    add_static_evidence(seen, known_.map, std::vector{landmark_}, evidence);
  const Landmark& landmark = *known_.map.landmark(landmark_);
  EXPECT_FLOAT_EQ(landmark.static_log_odds + evidence.at(landmark_).static_log_odds,
                  kMaxStaticLogOdds);
  EXPECT_EQ(evidence.at(landmark_).found, 2000u);
}

}  // namespace
}  // namespace stillpoint::orb_slam
