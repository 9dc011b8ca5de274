#include "orb_slam/tracker.hpp"

#include "orb_slam/tracker_fixture.hpp"

namespace stillpoint::orb_slam {
namespace {

using Use = TrackedFeature::Use;

TEST_F(TrackerTest, FollowsTranslation) {
  track_along([](double t) { return pose_at({0.6 * t, -0.2 * t, 0.4 * t}); }, 25);
  EXPECT_GT(map_.keyframe_count(), 1u);
}

TEST_F(TrackerTest, FollowsRotation) {
  track_along([](double t) { return pose_at({0, 0, 0}, {0.1 * t, 0.5 * t, 0.4 * t}); }, 25);
  EXPECT_GT(map_.keyframe_count(), 1u);
}

TEST_F(TrackerTest, FollowsAFlatWall) {
  scene_ = TestScene({{-4, -3, 8, 6, 2.0}});
  track_along([](double t) { return pose_at({0.8 * t, 0, 0.1 * t}, {0, -0.3 * t, 0}); }, 25);
}

// A new key frame in room not seen before shares few landmarks with others; that must not delay the
// next one.
TEST_F(TrackerTest, KeyFramesComeEvenlyInUnseenRoom) {
  scene_ = TestScene({{-2, -2, 11, 4, 2.5}});
  constexpr double kStep = 0.06;  // metres
  double last = 0, farthest = 0;
  for (int i = 0; i < 100; ++i) {
    const Pose pose = pose_at({kStep * i, 0, 0});
    const TrackResult result = step(pose);
    expect_at(result, pose, 0.02, 0.01);
    if (!result.keyframe) continue;
    farthest = std::max(farthest, kStep * i - last);
    last = kStep * i;
  }
  EXPECT_LT(farthest, 0.7) << "the view is 3 m wide";
  EXPECT_GT(farthest, 2 * kStep) << "nor all the time";
}

TEST_F(TrackerTest, FirstFrameIsTheOrigin) {
  const TrackResult result = step(Pose::Identity());
  EXPECT_EQ(result.state, TrackState::kTracking);
  ASSERT_TRUE(result.keyframe);
  EXPECT_EQ(result.keyframe->id, 0u);
  EXPECT_EQ(result.keyframe->frame, 0u);
  EXPECT_EQ(result.reference, 0u);
  EXPECT_EQ(result.world_from_camera.matrix(), Pose::Identity().matrix());
  EXPECT_EQ(result.reference_from_camera.matrix(), Pose::Identity().matrix());
}

TEST_F(TrackerTest, ResultsAreInAgreementWithEachOther) {
  for (int i = 0; i < 12; ++i) {
    const SparseMap before = map_;
    const TrackResult result = step(pose_at({0.04 * i, 0, 0}));
    ASSERT_EQ(result.state, TrackState::kTracking);
    EXPECT_EQ(static_cast<std::size_t>(result.features), result.tracked.size());
    EXPECT_LE(result.inliers, result.matches);
    EXPECT_LE(result.matches, result.features);
    const auto inliers = std::count_if(result.tracked.begin(), result.tracked.end(),
                                       [](const auto& f) { return f.use == Use::kInlier; });
    EXPECT_EQ(inliers, result.inliers);
    const Pose reference = result.keyframe ? result.keyframe->world_from_camera
                                           : before.world_from_keyframe(result.reference);
    EXPECT_TRUE(
        (reference * result.reference_from_camera).isApprox(result.world_from_camera, 1e-9));
    if (result.keyframe) {
      EXPECT_EQ(result.reference, result.keyframe->id);
    }
  }
}

TEST_F(TrackerTest, WithoutDepthItWaits) {
  for (int i = 0; i < 3; ++i) {
    auto frame = std::make_shared<Frame>(*scene_.render(Pose::Identity(), next_++));
    frame->depth = cv::Mat::zeros(frame->depth.size(), CV_32FC1);
    const TrackResult result = step(frame);
    EXPECT_EQ(result.state, TrackState::kWaiting);
    EXPECT_FALSE(result.keyframe);
  }
  expect_at(step(pose_at({0.5, 0, 0})), Pose::Identity());  // the world begins where it starts
  expect_at(step(pose_at({0.52, 0, 0})), pose_at({0.02, 0, 0}));
}

TEST_F(TrackerTest, DepthGivesThePoseInAPlainCorner) {
  for (int i = 0; i < 40; ++i) {
    SCOPED_TRACE(i);
    const double t = i / 39.0;
    const Pose truth = pose_at({-0.3 * t, 0.1 * t, 0.2 * t}, {-0.1 * t, 0.2 * t, 0.05 * t});
    const TrackResult result = step(render_planes({kAhead, kRight, kFloor}, truth, next_++, 0.002));
    expect_at(result, truth);
    EXPECT_FALSE(result.uncertainty->poorly_constrained());
    EXPECT_EQ(result.depth_registered, i > 0);
  }
}

// A lens that is covered for a moment.

TEST_F(TrackerTest, ASlideAlongAWallIsReported) {
  scene_ = TestScene({{-4, -3, 8, 6, 3.0}});
  for (int i = 0; i < 6; ++i) expect_at(step(pose_at({0.01 * i, 0, 0})), pose_at({0.01 * i, 0, 0}));
  for (int i = 6; i < 12; ++i) {
    SCOPED_TRACE(i);
    const Pose truth = pose_at({0.01 * i, 0, 0.01 * (i - 6)});
    const TrackResult result = step(render_planes({{{0, 0, 1}, 3.0}}, truth, next_++, 0.002));
    ASSERT_EQ(result.state, TrackState::kTracking);
    EXPECT_TRUE(result.depth_registered);
    EXPECT_TRUE(result.uncertainty->poorly_constrained());
    EXPECT_GT(result.uncertainty->covariance(0, 0), 0.5) << "along the wall";
    EXPECT_LT(result.uncertainty->covariance(2, 2), 0.01 * 0.01) << "away from it";
    EXPECT_NEAR(result.world_from_camera.translation().z(), truth.translation().z(), 0.004);
  }
}

TEST_F(TrackerTest, WhereLandmarksSufficeDepthIsNotAsked) {
  std::vector<Pose> poses;
  for (int i = 0; i < 8; ++i) {
    const TrackResult result = step(pose_at({0.05 * i, 0, 0}));
    EXPECT_FALSE(result.depth_registered);
    EXPECT_LT(result.uncertainty->metres(), 0.01);
    poses.push_back(result.world_from_camera);
  }
  OrbTracker::Options without;
  without.register_depth = false;
  const auto same = anew(without);
  for (std::size_t i = 0; i < poses.size(); ++i) EXPECT_EQ(same[i].matrix(), poses[i].matrix());
}

TEST_F(TrackerTest, SurfacesOfNoWeightDoNotHold) {
  const auto corner = [&](const Pose& pose) {
    return render_planes({kAhead, kRight, kFloor}, pose, next_++, 0.002);
  };
  StaticWeights person;
  person.track = cv::Mat::zeros(480, 640, CV_8UC1);
  for (int i = 0; i < 3; ++i) step(corner(pose_at({0.01 * i, 0, 0})));
  EXPECT_EQ(step(corner(pose_at({0.03, 0, 0})), person).state, TrackState::kLost);
}

TEST_F(TrackerTest, BlackFirstFrameWaits) {
  EXPECT_EQ(step(scene_.black(next_++)).state, TrackState::kWaiting);
  expect_at(step(Pose::Identity()), Pose::Identity());
}

TEST_F(TrackerTest, FeaturesOfNoWeightAreNotUsed) {
  StaticWeights weights;
  weights.track = cv::Mat(480, 640, CV_8UC1, cv::Scalar(255));
  weights.track(cv::Rect(200, 100, 250, 300)) = 0;
  int at_first = 0;
  for (int i = 0; i < 8; ++i) {
    const TrackResult result = step(pose_at({0.03 * i, 0, 0}), weights);
    expect_at(result, pose_at({0.03 * i, 0, 0}));
    int inside = 0;
    for (const TrackedFeature& f : result.tracked) {
      const bool moving =
          weights.track.at<std::uint8_t>(cvRound(f.pixel.y), cvRound(f.pixel.x)) == 0;
      EXPECT_EQ(f.use == Use::kMoving, moving);
      inside += moving;
    }
    if (i == 0) at_first = inside;
    EXPECT_GT(inside, 0);
    EXPECT_GE(at_first, i == 0 ? 100 : 3 * inside) << "from then on they are spent elsewhere";
    if (!result.keyframe) continue;
    for (std::uint32_t f = 0; f < result.tracked.size(); ++f)
      if (result.tracked[f].use == Use::kMoving) {
        EXPECT_EQ(result.keyframe->landmarks[f], kNoId);
      }
  }
}

TEST_F(TrackerTest, WhatIsHiddenIsMadeUpFor) {
  OrbTracker::Options options;
  options.max_feature_factor = 1.5;
  OrbTracker tracker(options);
  const auto features_with = [&](const cv::Rect& hidden) {
    StaticWeights weights;
    weights.map = cv::Mat(480, 640, CV_8UC1, cv::Scalar(255));
    weights.map(hidden) = 0;
    int features = 0;
    for (std::uint32_t i = 0; i < 2; ++i) {  // the next frame's features make up for this one's
      const FramePtr frame = scene_.render(Pose::Identity(), i);
      features = tracker.track(tracker.prepare(frame), weights, {}, {}).features;
    }
    return features;
  };
  const int usual = features_with({});
  // Within 8 px of the rest, something may be uncovered.
  EXPECT_NEAR(features_with({0, 0, 88, 480}), usual / (0.875 * 0.875), 0.03 * usual);
  EXPECT_NEAR(features_with({0, 0, 488, 480}), 1.5 * usual, 0.03 * usual);
  EXPECT_EQ(features_with({}), usual);
}

TEST_F(TrackerTest, MovingThingWithoutWeightDoesNotPull) {
  // The near panel goes its own way; its pixels have no weight.
  const auto scene_at = [](int i) {
    return TestScene({{-4, -3, 8, 6, 3.0}, {-0.6 + 0.04 * i, -0.6, 1.1, 1.2, 1.8}});
  };
  for (int i = 0; i < 10; ++i) {
    const Pose truth = pose_at({0, 0.02 * i, 0});
    const FramePtr frame = scene_at(i).render(truth, next_++);
    StaticWeights weights;
    weights.track = frame->depth > 2.5;
    cv::erode(weights.track, weights.track, cv::Mat(), {-1, -1}, 15);
    weights.map = weights.track;
    SCOPED_TRACE(i);
    expect_at(step(frame, weights), truth);
  }
}

TEST_F(TrackerTest, EverythingMovingAtTheStartWaits) {
  StaticWeights weights;
  weights.track = cv::Mat::zeros(480, 640, CV_8UC1);
  EXPECT_EQ(step(Pose::Identity(), weights).state, TrackState::kWaiting);
}

// Landmarks could not be made of them.

TEST_F(TrackerTest, WhatMustNotBeMappedDoesNotBeginTheMap) {
  StaticWeights weights;
  weights.map = cv::Mat(480, 640, CV_8UC1, cv::Scalar(0));
  EXPECT_EQ(step(Pose::Identity(), weights).state, TrackState::kWaiting);
  EXPECT_EQ(step(Pose::Identity()).state, TrackState::kTracking);
}

TEST_F(TrackerTest, FollowsWhenMappingMovesTheMap) {
  for (int i = 0; i < 6; ++i) step(pose_at({0.03 * i, 0, 0}));
  const Pose shift = pose_at({0.3, -0.2, 0.1}, {0, 0.2, 0});  // as after a loop closure
  MapEdit edit(map_);
  for (KeyFrameId id = 0; id < map_.keyframe_id_end(); ++id)
    if (map_.keyframe(id)) {
      Pose& pose = edit.keyframe(id).world_from_camera;
      pose = shift * pose;
    }
  for (LandmarkId id = 0; id < map_.landmark_id_end(); ++id)
    if (map_.landmark(id)) {
      Landmark& landmark = edit.landmark(id);
      landmark.position_in_world = shift * landmark.position_in_world;
      landmark.mean_view = shift.linear() * landmark.mean_view;
    }
  map_ = std::move(edit).finish();
  expect_at(step(pose_at({0.18, 0, 0})), shift * pose_at({0.18, 0, 0}));
}

TEST_F(TrackerTest, TwoFramesOfOneTimeAreNoCrash) {
  for (int i = 0; i < 6; ++i) {
    auto frame = std::make_shared<Frame>(*scene_.render(pose_at({0.01 * i, 0, 0}), next_++));
    frame->time = i < 3 ? 0.1 * i : 0.3;
    expect_at(step(frame), pose_at({0.01 * i, 0, 0}));
  }
}

TEST_F(TrackerTest, ContinuesAnExistingMap) {
  for (int i = 0; i < 12; ++i) step(pose_at({0.05 * i, 0, 0}));
  const auto end = map_.keyframe_id_end();
  OrbTracker fresh{OrbTracker::Options{}};
  tracker_ = std::move(fresh);
  TrackResult result;
  for (int i = 0; i < 10 && result.state != TrackState::kTracking; ++i)
    result = step(pose_at({0.3, 0, 0}));
  expect_at(result, pose_at({0.3, 0, 0}));
  for (int i = 0; i < 30 && map_.keyframe_id_end() == end; ++i) step(pose_at({0.3, 0.03 * i, 0}));
  EXPECT_GT(map_.keyframe_id_end(), end);  // step() checks the ids
}

TEST_F(TrackerTest, SameFramesSameBits) {
  const auto first = anew({}), second = anew({});
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(first[i].matrix(), second[i].matrix());
}

TEST_F(TrackerTest, NewLandmarksAreOnProbationOnlyWhereSomethingMayMove) {
  OrbTracker::Options with_probation;
  with_probation.probation = 10;
  StaticWeights weights;
  weights.map = cv::Mat(480, 640, CV_8UC1, cv::Scalar(255));
  const auto static_scene = anew({}, weights),
             with_probation_static = anew(with_probation, weights);
  EXPECT_EQ(static_scene.back().matrix(), with_probation_static.back().matrix());
  weights.map(cv::Rect(0, 0, 160, 480)) = 0;
  const auto without = anew({}, weights), probation = anew(with_probation, weights);
  EXPECT_EQ(without.front().matrix(), probation.front().matrix());
  EXPECT_NE(without.back().matrix(), probation.back().matrix());
}

}  // namespace
}  // namespace stillpoint::orb_slam
