#include "map_checks/depth_consistency.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "map_checks/test_room.hpp"

namespace stillpoint::map_checks {
namespace {

constexpr double kRate = 10;  // frames per second
const TestBox kPerson{{-0.3, -0.6, 1.8}, {0.3, 1.2, 2.1}};
const TestBox kCrowd{{-0.75, -0.8, 1.2}, {0.55, 1.2, 1.4}};  // most of the picture

Pose pose(double x, double y, double z, double degrees = 0) {
  Pose result = Pose::Identity();
  result.linear() = exp_so3({0, degrees * std::numbers::pi / 180, 0});
  result.translation() = Eigen::Vector3d(x, y, z);
  return result;
}

/// Share of the cells of a mask in which a test holds.
double share(const cv::Mat& condition, const cv::Mat& mask) {
  return cv::countNonZero(condition & mask) / static_cast<double>(cv::countNonZero(mask));
}

/// The frame with a share of its pixels, drawn at random, without depth.
std::shared_ptr<const Frame> with_holes(const Frame& frame, double share) {
  auto result = std::make_shared<Frame>(frame);
  cv::Mat random(frame.depth.size(), CV_32F);
  cv::RNG(frame.index + 1).fill(random, cv::RNG::UNIFORM, 0, 1);
  result->depth = frame.depth.clone();
  result->depth.setTo(0, random < share);
  return result;
}

/// A check whose frames are tracked where the camera truly is.
class World {
 public:
  TestRoom room;
  StaticWeights weights;
  double holes = 0;  // share of the pixels without depth
  double time = 0;

  explicit World(const DepthConsistency::Options& options = {}, cv::Size size = {320, 240})
      : room(size), check_(options) {}

  /// The camera's way: to and fro, 0.2 m.
  Pose way() const { return pose(0.1 * std::sin(time), 0, 0, 2 * std::cos(time)); }

  MapEvidence next(std::optional<std::vector<Pose>> guesses = std::nullopt) {
    const auto frame = with_holes(*room.render(way(), time), holes);
    const std::vector<Pose> poses = guesses ? *guesses : std::vector<Pose>{way()};
    const MapEvidence evidence = check_.check(*frame, poses, map_);
    check_.remember({.frame = frame,
                     .weights = std::make_shared<const StaticWeights>(weights),
                     .world_from_camera = way()});
    time += 1 / kRate;
    return evidence;
  }
  void clear() { check_.clear(); }
  MapEvidence after(double seconds) {
    for (int i = 1; i < seconds * kRate; ++i) next();
    return next();
  }

 private:
  DepthConsistency check_;
  SparseMap map_;
};

TEST(DepthConsistency, KnowsNothingAtFirst) { EXPECT_TRUE(World().next().log_odds.empty()); }

TEST(DepthConsistency, WhatStandsIsStatic) {
  World world;
  const cv::Mat log_odds = world.after(4).log_odds;
  const cv::Mat all(log_odds.size(), CV_8U, cv::Scalar(255));
  EXPECT_GT(share(log_odds <= -4, all), 0.9);
  EXPECT_LT(share(log_odds > 0, all), 0.002);
}

TEST(DepthConsistency, WhoComesInIsSeenAtOnce) {
  World world;
  world.after(3);
  world.room.boxes.push_back(kPerson);
  const cv::Mat person = world.room.cells_of(kPerson, world.way(), kCell);
  const cv::Mat log_odds = world.next().log_odds;
  EXPECT_GT(share(log_odds > 3, person), 0.95);
  EXPECT_LT(share(log_odds > 0, ~person), 0.01);
}

// As stereo and time-of-flight cameras leave them.
TEST(DepthConsistency, ScatteredHolesInDepthHideNobody) {
  World world;
  world.holes = 0.15;
  world.after(3);
  world.room.boxes.push_back(kPerson);
  const cv::Mat person = world.room.cells_of(kPerson, world.way(), kCell);
  const cv::Mat log_odds = world.next().log_odds;
  EXPECT_GT(share(log_odds > 3, person), 0.95);
  EXPECT_GT(share(log_odds <= -4, ~person), 0.8);
}

TEST(DepthConsistency, WhereSomebodyWasTheRoomIsStatic) {
  World world;
  world.after(2);
  world.room.boxes.push_back(kPerson);
  world.weights.track = world.weights.map = cv::Mat(240, 320, CV_8U, cv::Scalar(255));
  world.after(0.5);
  world.room.boxes.pop_back();
  const cv::Mat log_odds = world.next().log_odds;
  EXPECT_LT(share(log_odds > 0, cv::Mat(log_odds.size(), CV_8U, cv::Scalar(255))), 0.002);
}

// Most of the picture moves, and the first guess follows it: the surfaces of before outvote both.
TEST(DepthConsistency, ACrowdDoesNotTakeTheCameraAlong) {
  World world;
  world.after(3);
  world.room.boxes.push_back(kCrowd);
  const cv::Mat crowd = world.room.cells_of(kCrowd, world.way(), kCell);
  ASSERT_GT(cv::countNonZero(crowd), 0.55 * crowd.total());
  const Pose true_pose = world.way();
  const cv::Mat log_odds =
      world.next({{true_pose * pose(0.15, 0.02, 0.1, 5), true_pose * pose(0.01, 0.005, 0.01, 0.8)}})
          .log_odds;
  ASSERT_FALSE(log_odds.empty());
  EXPECT_GT(share(log_odds > 3, crowd), 0.95);
  EXPECT_GT(share(log_odds <= -4, ~crowd), 0.75);
}

TEST(DepthConsistency, AMapThatWasClearedIsForgotten) {
  World world;
  world.after(3);
  world.clear();
  EXPECT_TRUE(world.next().log_odds.empty());
  EXPECT_FALSE(world.after(1).log_odds.empty());
}

TEST(DepthConsistency, APoseThatDoesNotFitSaysNothing) {
  World world;
  world.after(3);
  EXPECT_TRUE(world.next({{world.way() * pose(0.8, -0.4, 0.9, 35)}}).log_odds.empty());
}

TEST(DepthConsistency, WhatIsPutDownIsBelievedInTime) {
  DepthConsistency::Options options;
  options.surface.rest_time = 2;
  World world(options);
  world.after(3);
  world.room.boxes.push_back(kPerson);
  const auto share_of_mover = [&](const MapEvidence& evidence) {
    return share(evidence.log_odds > 0, world.room.cells_of(kPerson, world.way(), kCell));
  };
  world.weights.map = cv::Mat(240, 320, CV_8U, cv::Scalar(255));
  world.weights.map.setTo(0);  // whoever it is, it is not mapped while it is new
  EXPECT_GT(share_of_mover(world.after(1)), 0.9);
  EXPECT_LT(share_of_mover(world.after(2.5)), 0.1);
}

TEST(DepthConsistency, WhatWasNotTrustedSaysLittle) {
  World world;
  world.weights.track = world.weights.map = cv::Mat(240, 320, CV_8U, cv::Scalar(0));
  const cv::Mat log_odds = world.after(3).log_odds;
  if (!log_odds.empty()) {
    double lowest = 0;
    cv::minMaxLoc(log_odds, &lowest);
    EXPECT_GT(lowest, -1);
  }
}

TEST(DepthConsistency, TakesImagesOfAnySize) {
  World world({}, {251, 187});
  const cv::Mat log_odds = world.after(2).log_odds;
  EXPECT_EQ(log_odds.size(), cv::Size(251 / kCell, 187 / kCell));
  EXPECT_GT(share(log_odds < 0, cv::Mat(log_odds.size(), CV_8U, cv::Scalar(255))), 0.8);
}

TEST(DepthConsistency, NoDepthIsNoEvidence) {
  World world;
  world.after(2);
  const auto frame = std::const_pointer_cast<Frame>(world.room.render(world.way(), world.time));
  frame->depth.setTo(0);
  DepthConsistency check({});
  const Pose here = world.way();
  EXPECT_TRUE(check.check(*frame, {&here, 1}, {}).log_odds.empty());
}

TEST(DepthConsistency, TheSameFramesGiveTheSameEvidence) {
  World a, b;
  const cv::Mat first = a.after(2).log_odds, second = b.after(2).log_odds;
  EXPECT_EQ(cv::countNonZero(first != second), 0);
}

TEST(ViewMemory, KeepsTheOldAndTheNew) {
  TestRoom room({64, 48});
  ViewMemory memory({.views = 5});
  const auto weights = std::make_shared<const StaticWeights>();
  for (int i = 0; i < 300; ++i) {
    const TrackedFrame frame{.frame = room.render(Pose::Identity(), i / 30.0), .weights = weights};
    if (memory.is_new_view(frame)) memory.add(make_view(frame));
  }
  const auto& views = memory.views();
  ASSERT_EQ(views.size(), 5u);
  EXPECT_GT(views.front().time, 9.0);
  EXPECT_LT(views.back().time, 1.0);
  for (std::size_t i = 1; i < views.size(); ++i) EXPECT_LT(views[i].time, views[i - 1].time);
}

TEST(ViewMemory, ViewsMoveWithTheMap) {
  TestRoom room({64, 48});
  ViewMemory memory({});
  KeyFrame keyframe{.id = 0};
  keyframe.features = std::make_shared<const Features>();
  keyframe.world_from_camera = pose(1, 2, 3);
  MapEdit edit({});
  edit.add_keyframe(keyframe);
  const SparseMap map = std::move(edit).finish();
  View view = make_view({.frame = room.render(Pose::Identity(), 0),
                         .weights = std::make_shared<const StaticWeights>(),
                         .reference = 0,
                         .reference_from_camera = pose(0.5, 0, 0)});
  view.tracked_from_depth = pose(0, 0, 0.01);
  memory.add(std::move(view));
  memory.move_to(map);
  EXPECT_TRUE(memory.views()[0].world_from_camera.isApprox(pose(1.5, 2, 3.01)));
}

TEST(ViewAlignment, FindsThePoseToMillimetres) {
  TestRoom room;
  ViewMemory memory({});
  memory.add(make_view({.frame = room.render(Pose::Identity(), 0),
                        .weights = std::make_shared<const StaticWeights>()}));
  const View& view = memory.views()[0];
  const View* const views[] = {&view};
  const Pose true_pose = pose(0.05, -0.02, 0.04, 2);
  const auto frame = room.render(true_pose, 1);
  const Pose guess = true_pose * pose(0.02, 0.01, -0.015, 1);
  const ViewAlignment found =
      align(sample_depth(frame->depth), CellCamera(*frame->camera), {&guess, 1}, views);
  const Pose off = true_pose.inverse() * found.world_from_camera;
  EXPECT_LT(off.translation().norm(), 0.012);
  EXPECT_LT(rotation_angle(off), 0.005);
  EXPECT_GT(found.agreement, 0.9);
}

TEST(ViewAlignment, ANoisierSensorFitsAsWell) {
  TestRoom room;
  ViewMemory memory({});
  memory.add(make_view({.frame = room.render(Pose::Identity(), 0),
                        .weights = std::make_shared<const StaticWeights>()}));
  const View* const views[] = {&memory.views()[0]};
  const Pose true_pose = pose(0.05, -0.02, 0.04, 2);
  const auto frame = room.render(true_pose, 1);
  Camera camera = *frame->camera;
  camera.surface_noise = 0.02;  // m at 1 m: ten times a Kinect's
  cv::RNG random(7);
  cv::Mat noisy = sample_depth(frame->depth);
  for (float& z : cv::Mat_<float>(noisy)) z += random.gaussian(camera.surface_noise * z * z);
  const Pose guess = true_pose * pose(0.02, 0.01, -0.015, 1);
  const ViewAlignment known = align(noisy, CellCamera(camera), {&guess, 1}, views);
  EXPECT_GT(known.agreement, 0.9);
  EXPECT_LT((true_pose.inverse() * known.world_from_camera).translation().norm(), 0.05);
  const ViewAlignment taken_for_a_kinect =
      align(noisy, CellCamera(*frame->camera), {&guess, 1}, views);
  EXPECT_LT(taken_for_a_kinect.agreement, 0.7);
}

/// A view of a camera that was tracked with an error, before one without.
class BadlyTrackedView : public ::testing::Test {
 protected:
  Pose fitted(const Pose& error, const StaticWeights& weights = {}) const {
    const View before = make_view({.frame = room_.render(Pose::Identity(), 0),
                                   .weights = std::make_shared<const StaticWeights>()});
    const View view = make_view({.frame = room_.render(true_pose_, 1),
                                 .weights = std::make_shared<const StaticWeights>(weights),
                                 .world_from_camera = true_pose_ * error});
    const View* const others[] = {&before};
    return tracked_from_depth(view, others, 0.5);
  }

 private:
  TestRoom room_;
  Pose true_pose_ = pose(0.05, -0.02, 0.04, 2);
};

TEST_F(BadlyTrackedView, FitsTheOthersToMillimetres) {
  const Pose error = pose(0.01, 0, -0.012, 0.6);
  const Pose left = error * fitted(error);
  EXPECT_LT(left.translation().norm(), 0.006);
  EXPECT_LT(rotation_angle(left), 0.003);
}

// Farther off, it is not the tracking.
TEST_F(BadlyTrackedView, IsMovedByCentimetresAtMost) {
  const Pose offset = fitted(pose(0, 0, -0.08));
  EXPECT_GT(offset.translation().z(), 0.02);
  EXPECT_LT(offset.translation().norm(), 0.026);
}

TEST_F(BadlyTrackedView, StaysWhereNothingInItIsStatic) {
  StaticWeights weights;
  weights.track = weights.map = cv::Mat(240, 320, CV_8U, cv::Scalar(0));
  EXPECT_TRUE(fitted(pose(0, 0, -0.01), weights).isApprox(Pose::Identity()));
}

}  // namespace
}  // namespace stillpoint::map_checks
