// The four decisions on frames with known truth.
#include <gtest/gtest.h>

#include "decision_objects/bayes.hpp"
#include "decision_objects/geometry_only.hpp"
#include "decision_objects/object_vote.hpp"
#include "decision_objects/semantic_only.hpp"
#include "decision_objects/test_frames.hpp"
#include "stillpoint/error.hpp"

namespace stillpoint::decision_objects {
namespace {

const cv::Rect kNowhere;

TEST(SemanticOnly, RemovesTheListedClassesAndAMargin) {
  SemanticOnly decision({.margin = 5}, with_classes());
  const StaticWeights w = decision.decide(make_frame(), make_labels(), {}, {});
  EXPECT_EQ(weight_at(w.track, 250, 200), 0);
  EXPECT_EQ(weight_at(w.track, kPerson.x - 4, 200), 0);
  EXPECT_EQ(weight_at(w.track, kPerson.x - 8, 200), 255);
  EXPECT_EQ(weight_at(w.map, 250, 200), 0);
  EXPECT_EQ(w.object_moves, std::vector{true});
}

TEST(SemanticOnly, LeavesOtherClassesAlone) {
  SemanticOnly decision({}, with_classes());
  const StaticWeights w = decision.decide(make_frame(), make_labels(9), {}, {});
  EXPECT_EQ(weight_at(w.track, 250, 200), 255);
  EXPECT_EQ(w.object_moves, std::vector{false});
}

TEST(Classes, AreCheckedAtTheStart) {
  EXPECT_THROW(SemanticOnly({.labels = {"persn"}}, with_classes()), Error);
  EXPECT_THROW(SemanticOnly({}, with_classes("")), Error);
  EXPECT_THROW(SemanticOnly({.labels = {"chair"}}, with_classes("person")), Error);
  EXPECT_NO_THROW(SemanticOnly({.labels = {"person", "chair"}}, with_classes("person")));
  try {
    ObjectVote({.labels = {"persn"}}, with_classes());
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kUsage);
    EXPECT_NE(std::string(error.what()).find("did you mean 'person'?"), std::string::npos);
  }
  Bayes::Options options;
  options.classes["persn"] = {};
  EXPECT_THROW(Bayes(options, with_classes()), Error);
  EXPECT_NO_THROW(Bayes({}, with_classes("person")));  // policies for chairs do no harm
  EXPECT_NO_THROW(Bayes({}, with_classes("")));
}

TEST(BayesTest, ClassesThatItDoesNotKnowAreWarnedOf) {
  StageContext context;
  context.classes = {"background", "human"};
  std::string warning;
  context.log = [&](LogLevel, std::string_view text) { warning = text; };
  Bayes decision({}, context);
  EXPECT_NE(warning.find("none of the segmenter's classes"), std::string::npos) << warning;
  context = with_classes("person");
  warning.clear();
  context.log = [&](LogLevel, std::string_view text) { warning = text; };
  Bayes known({}, context);
  EXPECT_EQ(warning, "");
}

TEST(ObjectVote, WhoWalksIsRemovedWhoStandsIsKept) {
  ObjectVote decision({}, with_classes());
  const StaticWeights walks =
      decision.decide(make_frame(), make_labels(), make_points(kPerson), {});
  EXPECT_EQ(weight_at(walks.track, 250, 200), 0);
  EXPECT_EQ(weight_at(walks.track, 500, 200), 255);
  const StaticWeights stands =
      decision.decide(make_frame(), make_labels(), make_points(kNowhere), {});
  EXPECT_EQ(weight_at(stands.track, 250, 200), 255);
  EXPECT_EQ(stands.object_moves, std::vector{false});
}

TEST(ObjectVote, NeedsANumberAndAShareOfPoints) {
  const MovingPoints tenth = make_points(kPerson, 0.1);
  EXPECT_FALSE(ObjectVote({.min_moving_points = 3, .min_moving_share = 0.3}, with_classes())
                   .decide(make_frame(), make_labels(), tenth, {})
                   .object_moves[0]);
  EXPECT_FALSE(ObjectVote({.min_moving_points = 50, .min_moving_share = 0}, with_classes())
                   .decide(make_frame(), make_labels(), tenth, {})
                   .object_moves[0]);
  EXPECT_TRUE(ObjectVote({.min_moving_points = 3, .min_moving_share = 0.05}, with_classes())
                  .decide(make_frame(), make_labels(), tenth, {})
                  .object_moves[0]);
}

TEST(ObjectVote, UnreliablePointsLeaveItToUnsure) {
  MovingPoints points = make_points(kNowhere);
  points.reliable = false;
  using Unsure = ObjectVote::Unsure;
  for (const auto& [unsure, moves] : {std::pair{Unsure::kMoves, true}, {Unsure::kStatic, false}})
    EXPECT_EQ(ObjectVote({.unsure = unsure}, with_classes())
                  .decide(make_frame(), make_labels(), points, {})
                  .object_moves[0],
              moves);
}

TEST(GeometryOnly, FindsWhatMovesWithoutLabelsUpToItsEdge) {
  GeometryOnly decision({});
  StaticWeights w;
  for (std::uint32_t i = 0; i < 4; ++i)
    w = decision.decide(make_frame(i), {}, make_points(kPerson), {});
  EXPECT_EQ(weight_at(w.track, 250, 200), 0);
  EXPECT_EQ(weight_at(w.track, 310, 390), 0);
  EXPECT_EQ(weight_at(w.track, kPerson.x - 8, 200), 255);  // the wall right behind
  EXPECT_EQ(weight_at(w.track, 500, 200), 255);
}

TEST(GeometryOnly, ForgetsWhatStandsStillAgain) {
  GeometryOnly decision({});
  for (std::uint32_t i = 0; i < 10; ++i)
    decision.decide(make_frame(i), {}, make_points(kPerson), {});
  StaticWeights w;
  for (std::uint32_t i = 10; i < 25; ++i)
    w = decision.decide(make_frame(i), {}, make_points(kNowhere), {});
  EXPECT_EQ(weight_at(w.track, 250, 200), 255);
}

TEST(GeometryOnly, SurvivesImagesWithoutDepthAndPoints) {
  GeometryOnly decision({});
  Frame frame = make_frame();
  frame.depth.setTo(0);
  EXPECT_EQ(weight_at(decision.decide(frame, {}, {}, {}).track, 10, 10), 255);
  EXPECT_EQ(decision.decide(frame, {}, make_points(kPerson), {}).track.size(), frame.gray.size());
}

TEST(Bayes, AClassWithAHighPriorIsNotUsedBeforeAnythingIsMeasured) {
  Bayes decision({}, with_classes());
  const StaticWeights person = decision.decide(make_frame(), make_labels(15), {}, {});
  EXPECT_EQ(weight_at(person.track, 250, 200), 0);
  EXPECT_EQ(person.object_moves, std::vector{true});
  const StaticWeights chair =
      Bayes({}, with_classes()).decide(make_frame(), make_labels(9), {}, {});
  EXPECT_EQ(weight_at(chair.track, 250, 200), 255);
}

TEST(Bayes, WhoSitsStillIsTrustedSlowlyAndDistrustedAtOnce) {
  Bayes decision({}, with_classes());
  std::uint32_t i = 0;
  int frames_until_used = 0;
  StaticWeights w;
  do {
    w = decision.decide(make_frame(i++), make_labels(), make_points(kNowhere), {});
    ++frames_until_used;
  } while (weight_at(w.track, 250, 200) == 0 && frames_until_used < 100);
  EXPECT_GT(frames_until_used, 5);
  EXPECT_LT(frames_until_used, 40);
  EXPECT_FALSE(w.object_moves[0]);
  EXPECT_EQ(weight_at(w.map, 250, 200), 0) << "people are never mapped";
  for (int k = 0; k < 3; ++k)
    w = decision.decide(make_frame(i++), make_labels(), make_points(kPerson), {});
  EXPECT_EQ(weight_at(w.track, 250, 200), 0);
  EXPECT_TRUE(w.object_moves[0]);
}

TEST(Bayes, AChairThatIsPushedMoves) {
  Bayes decision({}, with_classes());
  StaticWeights w;
  for (std::uint32_t i = 0; i < 6; ++i)
    w = decision.decide(make_frame(i), make_labels(9), make_points(kPerson), {});
  EXPECT_TRUE(w.object_moves[0]);
  EXPECT_EQ(weight_at(w.track, 250, 200), 0);
  EXPECT_EQ(weight_at(w.map, 250, 200), 0);
}

TEST(Bayes, FindsUnlabelledThings) {
  Bayes decision({}, with_classes());
  StaticWeights w;
  for (std::uint32_t i = 0; i < 5; ++i)
    w = decision.decide(make_frame(i), {}, make_points(kPerson), {});
  EXPECT_LT(weight_at(w.track, 250, 200), 60);
  EXPECT_EQ(weight_at(w.track, 500, 200), 255);
}

// Somebody in dark clothes, whom the network overlooks.
TEST(Bayes, WhatHasComeInIsNotUsed) {
  Bayes decision({}, with_classes());
  const StaticWeights w =
      decision.decide(make_frame(), make_labels(5, {0, 0, 40, 40}), {}, make_evidence(kPerson, 6));
  EXPECT_EQ(weight_at(w.track, 250, 200), 0);
  EXPECT_EQ(weight_at(w.map, 250, 200), 0);
  EXPECT_EQ(weight_at(w.track, 500, 200), 255);
}

// Who fills most of the picture is at rest, as two frames alone can tell.
TEST(Bayes, PointsAtRestSayNothingOfWhatHasComeIn) {
  Bayes decision({}, with_classes());
  StaticWeights w;
  for (std::uint32_t i = 0; i < 30; ++i)
    w = decision.decide(make_frame(i), {}, make_points(kNowhere), make_evidence(kPerson, 6));
  EXPECT_EQ(weight_at(w.track, 250, 200), 0);
  EXPECT_EQ(weight_at(w.track, 500, 200), 255);
}

// A desk that is called a person for a second: the map has long known it.
TEST(Bayes, TheMapContradictsLabels) {
  Bayes decision({}, with_classes());
  const cv::Rect upper(kPerson.x, kPerson.y, kPerson.width, kPerson.height / 2);
  const StaticWeights w =
      decision.decide(make_frame(), make_labels(), {}, make_evidence(upper, -6));
  EXPECT_EQ(weight_at(w.track, 250, 180), 255);
  EXPECT_EQ(weight_at(w.map, 250, 180), 255);
  EXPECT_EQ(weight_at(w.track, 250, 350), 0) << "of this half the map knows nothing";
  EXPECT_EQ(weight_at(w.map, 250, 350), 0);
}

// Who sits still is where the map saw them, but they are never mapped: neither in a corner of the
// image nor close before the camera.
TEST(Bayes, WhoOnlySitsStillIsNotMapped) {
  for (const cv::Rect& box : {kPerson, cv::Rect(80, 60, 400, 420)}) {
    Bayes decision({}, with_classes());
    StaticWeights w;
    for (std::uint32_t i = 0; i < 60; ++i)
      w = decision.decide(make_frame(i), make_labels(15, box), make_points(kNowhere),
                          make_evidence(box, -2.4F));
    EXPECT_EQ(weight_at(w.track, 250, 200), 255);
    EXPECT_EQ(weight_at(w.map, 250, 200), 0);
  }
}

// A network that takes the desk and all that is on it for a person leaves little to track by.
TEST(Bayes, TheMoreIsLabelledTheLessALabelCounts) {
  const auto weights = [](const cv::Rect& labelled, float evidence) {
    Bayes decision({}, with_classes());
    return decision.decide(make_frame(), make_labels(15, labelled), {},
                           make_evidence(kPerson, evidence));
  };
  constexpr float kOneTracked = -0.3F, kTwoMapped = -3.1F;  // views
  const cv::Rect most(0, 0, 640, 440);
  const StaticWeights few = weights(kPerson, kTwoMapped);
  EXPECT_EQ(weight_at(few.track, 250, 200), 0);
  EXPECT_EQ(weight_at(few.map, 250, 200), 0);
  const StaticWeights many = weights(most, kTwoMapped);
  EXPECT_EQ(weight_at(many.track, 250, 200), 255);
  EXPECT_EQ(weight_at(many.map, 250, 200), 255);
  EXPECT_EQ(weight_at(many.track, 500, 200), 255);
  EXPECT_EQ(weight_at(many.map, 500, 200), 0) << "the map does not know it yet";
  EXPECT_EQ(weight_at(weights(most, kOneTracked).map, 250, 200), 0) << "nor this";
}

TEST(Bayes, TheOtherClassesSayNothingOfWhatHasNoLabel) {
  Bayes decision({.other = {.prior = 0.8}}, with_classes());
  const StaticWeights w = decision.decide(make_frame(), make_labels(5), make_points(kNowhere), {});
  EXPECT_EQ(weight_at(w.track, 250, 200), 0) << "a bottle, by its prior";
  EXPECT_EQ(weight_at(w.track, 500, 200), 255);
}

TEST(Bayes, UnreliablePointsChangeNothing) {
  MovingPoints points = make_points(kPerson);
  points.reliable = false;
  Bayes decision({}, with_classes());
  StaticWeights w;
  for (std::uint32_t i = 0; i < 10; ++i)
    w = decision.decide(make_frame(i), make_labels(9), points, {});
  EXPECT_FALSE(w.object_moves[0]);
  EXPECT_EQ(weight_at(w.track, 250, 200), 255);
}

TEST(Bayes, BeliefsFollowObjectsByTheirId) {
  Bayes decision({}, with_classes());
  Segmentation labels = make_labels();
  labels.objects[0].id = 7;
  StaticWeights w;
  for (std::uint32_t i = 0; i < 60; ++i)
    w = decision.decide(make_frame(i), labels, make_points(kNowhere), {});
  EXPECT_FALSE(w.object_moves[0]);
  Segmentation elsewhere = make_labels(15, cv::Rect(450, 100, 120, 300));
  elsewhere.objects[0].id = 7;
  EXPECT_FALSE(
      decision.decide(make_frame(60), elsewhere, make_points(kNowhere), {}).object_moves[0]);
  elsewhere.objects[0].id = 8;
  EXPECT_TRUE(
      decision.decide(make_frame(61), elsewhere, make_points(kNowhere), {}).object_moves[0]);
}

TEST(Bayes, WhoWasMissedForLongIsJudgedByTheClassAgain) {
  Segmentation labels = make_labels();
  labels.objects[0].id = 7;
  const auto moves_after_missing = [&](std::uint32_t missed) -> bool {
    Bayes decision({}, with_classes());
    std::uint32_t i = 0;
    while (i < 60) decision.decide(make_frame(i++), labels, make_points(kNowhere), {});
    while (i < 60 + missed) decision.decide(make_frame(i++), {}, make_points(kNowhere), {});
    return decision.decide(make_frame(i), labels, make_points(kNowhere), {}).object_moves[0];
  };
  EXPECT_FALSE(moves_after_missing(3));
  EXPECT_TRUE(moves_after_missing(120));
}

}  // namespace
}  // namespace stillpoint::decision_objects
