#include "evaluation/evaluation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "evaluation/report.hpp"
#include "fixtures.hpp"
#include "stillpoint/error.hpp"

namespace stillpoint::evaluation {
namespace {

constexpr double kExact = 1e-9;

// The same path with its world moved: what alignment has to undo.
Trajectory moved(Trajectory path, const Pose& world_from_old, double scale) {
  for (StampedPose& pose : path.poses) {
    pose.world_from_camera.translation() *= scale;
    pose.world_from_camera = world_from_old * pose.world_from_camera;
  }
  return path;
}

const Pose& some_pose() {
  static const Pose pose = exp_se3((Vector6d() << 3, -2, 5, 0.4, 1.9, -0.7).finished());
  return pose;
}

TEST(Evaluation, RigidMotionIsNoError) {
  const Trajectory path = winding_path(200, 0.05);
  const Evaluation e = evaluate(path, moved(path, some_pose(), 1), {}, {});
  EXPECT_EQ(e.pairs.size(), 200u);
  EXPECT_LT(e.rigid.metres.max, kExact);
  EXPECT_LT(e.relative->translation_m.max, kExact);
  EXPECT_LT(e.relative->rotation_deg.max, 1e-5);
  EXPECT_NEAR(e.similarity.reference_from_estimate.scale, 1, kExact);
}

TEST(Evaluation, ScaleIsFittedBySimilarityOnly) {
  const Trajectory path = winding_path(200, 0.05);
  const Evaluation e = evaluate(path, moved(path, some_pose(), 0.8), {}, {});
  EXPECT_NEAR(e.similarity.reference_from_estimate.scale, 1.25, kExact);
  EXPECT_LT(e.similarity.metres.max, kExact);
  EXPECT_GT(e.rigid.metres.rmse, 0.1);
}

TEST(Evaluation, APathThatIsNotLargerThanItsErrorDeterminesNoScale) {
  Trajectory path = winding_path(200, 0.05), estimate = path;
  const auto scale_of = [&](double extent, double straight) {
    for (std::size_t i = 0; i < path.poses.size(); ++i) {
      Eigen::Vector3d position = winding_path(200, 0.05).poses[i].world_from_camera.translation();
      position.tail<2>() *= straight;
      path.poses[i].world_from_camera.translation() = extent * position;
      estimate.poses[i].world_from_camera.translation() = 0.5 * extent * position;
      estimate.poses[i].world_from_camera.translation()[i % 3] += i % 2 == 0 ? 0.01 : -0.01;
    }
    return evaluate(path, estimate, {}, {});
  };
  const Evaluation wide = scale_of(1, 1);
  EXPECT_NEAR(wide.scale.value(), 2, 0.01) << "wrong, but determined";
  EXPECT_TRUE(wide.rigid_rotation_deg);
  const Evaluation straight = scale_of(1, 0.001);
  EXPECT_NEAR(straight.scale.value(), 2, 0.05);
  EXPECT_FALSE(straight.rigid_rotation_deg);
  const Evaluation at_rest = scale_of(0.005, 1);
  EXPECT_FALSE(at_rest.scale);
  EXPECT_FALSE(at_rest.rigid_rotation_deg);
}

// A circle disturbed by ±3 cm across its plane in turn: no rotation or shift can lessen that, so
// every error is 3 cm; the best scale is 1 / (1 + 0.03²).
AbsoluteError error_of(const Trajectory& reference, const Trajectory& estimate,
                       AlignmentKind kind) {
  const std::vector<TimePair> pairs = associate(times_of(reference), times_of(estimate), 0.01, 0.0);
  return absolute_error(reference, estimate, pairs, kind);
}

Trajectory moved(Trajectory trajectory, const Pose& by) {
  for (StampedPose& pose : trajectory.poses) pose.world_from_camera = by * pose.world_from_camera;
  return trajectory;
}

TEST(Evaluation, AlignmentsUndoWhatTheyKnow) {
  const Trajectory path = winding_path(50, 0.1);
  Pose yaw = Pose::Identity(), tilt = Pose::Identity();
  yaw.rotate(Eigen::AngleAxisd(2.0, Eigen::Vector3d::UnitZ()))
      .pretranslate(Eigen::Vector3d(1, 2, 3));
  tilt.rotate(Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX()));
  for (const AlignmentKind kind :
       {AlignmentKind::kRigid, AlignmentKind::kYaw, AlignmentKind::kOrigin}) {
    EXPECT_NEAR(error_of(path, moved(path, yaw), kind).metres.max, 0.0, 1e-9);
    EXPECT_NEAR(error_of(path, moved(path, yaw), kind).rotation_deg.max, 0.0, 1e-5);
  }
  EXPECT_NEAR(error_of(path, moved(path, tilt), AlignmentKind::kOrigin).metres.max, 0.0, 1e-9);
  EXPECT_GT(error_of(path, moved(path, tilt), AlignmentKind::kYaw).metres.rmse, 0.01);
  EXPECT_NEAR(error_of(path, moved(path, tilt), AlignmentKind::kYaw).rotation_deg.rmse, 5.73, 0.5);
  EXPECT_NEAR(error_of(path, path, AlignmentKind::kNone).metres.max, 0.0, 1e-12);
  Pose step = Pose::Identity();
  step.translation().x() = 0.25;
  EXPECT_NEAR(error_of(path, moved(path, step), AlignmentKind::kNone).metres.rmse, 0.25, 1e-9);
}

TEST(Evaluation, TheRotationErrorIsThatOfTheOrientations) {
  const Trajectory path = winding_path(50, 0.1);
  Trajectory turned = path;  // each camera about its own axis: positions stay
  for (StampedPose& pose : turned.poses)
    pose.world_from_camera.rotate(Eigen::AngleAxisd(M_PI / 60, Eigen::Vector3d::UnitZ()));
  const AbsoluteError error = error_of(path, turned, AlignmentKind::kRigid);
  EXPECT_NEAR(error.metres.max, 0.0, 1e-9);
  EXPECT_NEAR(error.rotation_deg.rmse, 3.0, 1e-6);
}

TEST(Evaluation, AbsoluteErrorOfADisturbedCircle) {
  Trajectory reference{"reference", {}, 0}, estimate{"estimate", {}, 0};
  for (int i = 0; i < 8; ++i) {
    const double angle = i * std::numbers::pi / 4;
    const Eigen::Vector3d point(std::cos(angle), std::sin(angle), 0);
    const Eigen::Vector3d shift(0, 0, i % 2 == 0 ? 0.03 : -0.03);
    reference.poses.push_back({1.0 * i, Pose(Eigen::Translation3d(point))});
    estimate.poses.push_back({1.0 * i, Pose(Eigen::Translation3d(point + shift))});
  }
  const Evaluation e = evaluate(reference, moved(estimate, some_pose(), 1), {}, {});
  for (double error : e.rigid.per_pair) EXPECT_NEAR(error, 0.03, kExact);
  EXPECT_NEAR(e.rigid.metres.standard_deviation, 0, kExact);
  const double scale = 1 / (1 + 0.03 * 0.03);
  EXPECT_NEAR(e.similarity.reference_from_estimate.scale, scale, kExact);
  EXPECT_NEAR(e.similarity.metres.rmse, std::hypot(1 - scale, 0.03 * scale), kExact);
}

// A camera that drifts 1 cm and half a degree per second.
TEST(Evaluation, RelativeErrorIsTheDriftPerSecond) {
  Trajectory reference{"reference", {}, 0}, estimate{"estimate", {}, 0};
  const double degree = std::numbers::pi / 180;
  for (int i = 0; i < 100; ++i) {
    const double s = 0.1 * i;
    reference.poses.push_back({s, Pose::Identity()});
    Pose drifted = Pose::Identity();
    drifted.linear() = exp_so3({0, 0, 0.5 * degree * s});
    drifted.translation() = Eigen::Vector3d(0, 0, 0.01 * s);
    estimate.poses.push_back({s, drifted});
  }
  const Evaluation e = evaluate(reference, estimate, {}, {});
  EXPECT_NEAR(e.relative->translation_m.rmse, 0.01, kExact);
  EXPECT_NEAR(e.relative->translation_m.standard_deviation, 0, kExact);
  EXPECT_NEAR(e.relative->rotation_deg.median, 0.5, 1e-6);
  EXPECT_EQ(e.relative->pairs, 89u);  // not the ten without successor, not the one to the last

  EvaluationOptions frames;
  frames.delta = {5, DeltaUnit::kFrames};
  EXPECT_NEAR(evaluate(reference, estimate, {}, frames).relative->translation_m.rmse, 0.005,
              kExact);
}

TEST(Evaluation, PairsOfAnotherIntervalAreCounted) {
  const Trajectory path = winding_path(400, 0.05);  // 20 s
  Trajectory keyframes = path, interrupted = path;
  keyframes.poses.clear();
  for (std::size_t i = 0; i < path.poses.size(); i += 50)  // every 2.5 s: the closest is the same
    keyframes.poses.push_back(path.poses[i]);
  EXPECT_EQ(evaluate(path, path, {}, {}).relative->of_another_interval, 0u);
  const RelativeError of_keyframes = evaluate(path, keyframes, {}, {}).relative.value();
  EXPECT_EQ(of_keyframes.of_another_interval, of_keyframes.pairs);
  interrupted.poses.erase(interrupted.poses.begin() + 100, interrupted.poses.begin() + 200);
  // Those from 4.5 s on, whose closest pose is the last one before the gap.
  const Evaluation e = evaluate(path, interrupted, {}, {});
  EXPECT_EQ(e.relative->of_another_interval, 10u);
  EXPECT_THAT(report_table(e),
              testing::HasSubstr("RPE: 10 of 279 pairs are less than half of 1 s"));
}

// A scale that is wrong by a hundredth: a centimetre per metre, however fast the camera moves.
TEST(Evaluation, RelativeErrorPerMetreDoesNotDependOnSpeed) {
  Trajectory reference{.name = "reference", .poses = {}}, estimate = reference;
  double way = 0;
  for (int i = 0; i < 400; ++i) {
    way += 0.02 + 0.015 * std::sin(0.1 * i);
    Pose pose = Pose::Identity();
    pose.translation() = Eigen::Vector3d(way, 0, 0);
    reference.poses.push_back({i / 30.0, pose});
    pose.translation() *= 1.01;
    estimate.poses.push_back({i / 30.0, pose});
  }
  EvaluationOptions metres;
  metres.delta = {1, DeltaUnit::kMetres};
  const Evaluation e = evaluate(reference, estimate, {}, metres);
  EXPECT_NEAR(e.relative->translation_m.mean, 0.01, 5e-4);  // poses are 0.5 to 3.5 cm apart
  EXPECT_LT(e.relative->translation_m.standard_deviation, 3e-4);
  EXPECT_GT(evaluate(reference, estimate, {}, {}).relative->translation_m.standard_deviation, 1e-3);
}

TEST(Evaluation, AlignedTrajectoriesLieOnTheReference) {
  const Trajectory path = winding_path(50, 0.1);
  const Evaluation e = evaluate(path, moved(path, some_pose(), 1.0), {}, {});
  const auto poses = aligned(e.rigid.reference_from_estimate, e.estimate);
  ASSERT_EQ(poses.size(), path.poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ(poses[i].time, path.poses[i].time);
    EXPECT_TRUE(poses[i].world_from_camera.isApprox(path.poses[i].world_from_camera, 1e-9));
  }
}

TEST(Evaluation, ShortRecordingHasNoRelativeError) {
  const Trajectory path = winding_path(10, 0.05);
  EXPECT_FALSE(evaluate(path, path, {}, {}).relative.has_value());
}

TEST(Evaluation, OffsetMovesTheEstimateInTime) {
  const Trajectory path = winding_path(50, 0.1);
  Trajectory late = path;
  for (StampedPose& pose : late.poses) pose.time += 1000;
  EvaluationOptions options;
  options.offset = -1000;
  const Evaluation e = evaluate(path, late, {}, options);
  EXPECT_EQ(e.pairs.size(), 50u);
  EXPECT_LT(e.relative->translation_m.max, kExact);
  EXPECT_NEAR(e.span.share, 1, kExact);
}

TEST(Evaluation, TooFewPairsAreAnErrorThatSaysWhy) {
  const Trajectory path = winding_path(50, 0.1);
  Trajectory late = path;
  for (StampedPose& pose : late.poses) pose.time += 1000;
  try {
    evaluate(path, late, {}, {});
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kData);
    EXPECT_THAT(error.what(), testing::HasSubstr("100.000 to 104.900 s"));
    EXPECT_THAT(error.what(), testing::HasSubstr("1100.000 to 1104.900 s"));
    EXPECT_THAT(error.what(), testing::HasSubstr("do not overlap"));
  }
  Trajectory two = path;
  two.poses.resize(2);
  EXPECT_THROW(evaluate(path, two, {}, {}), Error);
}

TEST(Coverage, GapsAndMissingEndsAreNotCovered) {
  const Trajectory reference = winding_path(101, 0.1);  // 10 s
  Trajectory estimate = reference;
  estimate.poses.erase(estimate.poses.begin() + 41, estimate.poses.begin() + 60);  // 2 s
  estimate.poses.resize(estimate.poses.size() - 10);                               // 1 s
  const SpanCoverage coverage = span_coverage(reference, estimate, 0);
  EXPECT_NEAR(coverage.share, 0.7, 1e-6);
  EXPECT_NEAR(coverage.longest_gap_s, 2.0, 1e-6);
}

TEST(Coverage, FramesCountOnce) {
  Trajectory estimate = winding_path(100, 0.1);
  const std::vector<double> frames = times_of(estimate);
  estimate.poses.erase(estimate.poses.begin() + 10, estimate.poses.begin() + 35);
  const FrameCoverage coverage = frame_coverage(frames, estimate, 0.02);
  EXPECT_EQ(coverage.frames, 100u);
  EXPECT_EQ(coverage.with_pose, 75u);
  EXPECT_EQ(coverage.share(), 0.75);
}

TEST(Statistics, MedianOfAnEvenNumberIsTheMeanOfTheMiddleTwo) {
  const Statistics s = statistics_of({4, 1, 3, 10});
  EXPECT_EQ(s.median, 3.5);
  EXPECT_EQ(s.mean, 4.5);
  EXPECT_EQ(s.min, 1);
  EXPECT_EQ(s.max, 10);
  EXPECT_NEAR(s.rmse, std::sqrt(126.0 / 4), kExact);
  EXPECT_NEAR(s.standard_deviation, std::sqrt(45.0 / 4), kExact);
}

}  // namespace
}  // namespace stillpoint::evaluation
