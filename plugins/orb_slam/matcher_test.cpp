#include "orb_slam/matcher.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "orb_slam/test_world.hpp"

namespace stillpoint::orb_slam {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

bool all(std::uint32_t) { return true; }

MATCHER_P2(Pairs, query, feature, "") { return arg.id == query && arg.feature == feature; }

class MatcherTest : public testing::Test {
 protected:
  std::uint32_t add_feature(double u, double v, const Descriptor& descriptor, int level = 0,
                            float angle = 0) {
    features_.keypoints.emplace_back(static_cast<float>(u), static_cast<float>(v), 31.f, angle, 0.f,
                                     level);
    features_.descriptors.push_back(descriptor);
    return static_cast<std::uint32_t>(features_.size() - 1);
  }
  Query query(std::uint32_t id, const Descriptor& descriptor, float angle = -1) const {
    return {.id = id,
            .descriptor = descriptor,
            .u = 100,
            .v = 100,
            .radius = 10,
            .min_level = 0,
            .max_level = 7,
            .angle = angle};
  }
  std::vector<Match> near(const std::vector<Query>& queries, const MatchRules& rules = {},
                          const FeatureFilter& usable = all) const {
    return match_near(queries, features_, FeatureGrid(features_, Camera{}), usable, rules);
  }
  std::vector<Match> anywhere(const std::vector<Query>& queries,
                              const MatchRules& rules = {}) const {
    return match_anywhere(queries, features_, all, rules);
  }

  TestWorld random_{0};
  Features features_;
};

TEST_F(MatcherTest, LooksInTheWindowOnly) {
  const Descriptor d = random_.descriptor();
  add_feature(111, 100, d);
  add_feature(100, 89, d);
  EXPECT_THAT(near({query(7, d)}), IsEmpty());
  add_feature(109, 91, d);
  EXPECT_THAT(near({query(7, d)}), ElementsAre(Pairs(7u, 2u)));
}

TEST_F(MatcherTest, LooksAtTheLevelsAskedForOnly) {
  const Descriptor d = random_.descriptor();
  for (int level = 0; level < 8; ++level) add_feature(100, 100, random_.flipped(d, 20), level);
  features_.descriptors[2] = d;  // the best one is on a wrong level
  Query q = query(1, d);
  q.min_level = 4;
  q.max_level = 4;
  EXPECT_THAT(near({q}), ElementsAre(Pairs(1u, 4u)));
}

TEST_F(MatcherTest, BestOfSeveralWithItsDistance) {
  const Descriptor d = random_.descriptor();
  add_feature(101, 100, random_.flipped(d, 60));
  Descriptor close = d;
  close[3] ^= 0b111;
  add_feature(102, 100, close);
  add_feature(103, 100, random_.descriptor());
  const auto matches = near({query(5, d)});
  ASSERT_THAT(matches, ElementsAre(Pairs(5u, 1u)));
  EXPECT_EQ(matches[0].distance, 3);
}

TEST_F(MatcherTest, RefusesWhatIsTooDifferent) {
  Descriptor d{};
  add_feature(100, 100, {0xffff, 0, 0, 0});
  EXPECT_THAT(near({query(0, d)}, {.max_distance = 16}), testing::SizeIs(1));
  EXPECT_THAT(near({query(0, d)}, {.max_distance = 15}), IsEmpty());
  EXPECT_THAT(anywhere({query(0, d)}, {.max_distance = 16}), testing::SizeIs(1));
  EXPECT_THAT(anywhere({query(0, d)}, {.max_distance = 15}), IsEmpty());
}

TEST_F(MatcherTest, UnusableFeaturesAreNoCandidates) {
  const Descriptor d = random_.descriptor();
  add_feature(100, 100, d);
  add_feature(101, 100, random_.flipped(d, 30));
  const auto not_first = [](std::uint32_t i) { return i != 0; };
  EXPECT_THAT(near({query(0, d)}, {}, not_first), ElementsAre(Pairs(0u, 1u)));
  EXPECT_THAT(match_anywhere(std::vector{query(0, d)}, features_, not_first, {}),
              ElementsAre(Pairs(0u, 1u)));
}

TEST_F(MatcherTest, OneQueryPerFeatureTheClosestFirst) {
  const Descriptor d = random_.descriptor();
  add_feature(100, 100, d);
  Descriptor one = d, five = d;
  one[0] ^= 1;
  five[1] ^= 31;
  const std::vector<Query> queries{query(10, five), query(11, one), query(12, five)};
  EXPECT_THAT(near(queries), ElementsAre(Pairs(11u, 0u)));
  EXPECT_THAT(anywhere(queries), ElementsAre(Pairs(11u, 0u)));
}

TEST_F(MatcherTest, AssignmentIsUniqueInBothDirections) {
  const Descriptor d = random_.descriptor();  // everything resembles everything
  std::vector<Query> queries;
  for (std::uint32_t i = 0; i < 200; ++i) {
    add_feature(random_.uniform(90, 110), random_.uniform(90, 110), random_.flipped(d, 15));
    queries.push_back(query(1000 + i, random_.flipped(d, 15)));
  }
  for (const auto& matches : {near(queries), anywhere(queries)}) {
    std::set<std::uint32_t> features, ids;
    for (const Match& m : matches) {
      EXPECT_TRUE(features.insert(m.feature).second);
      EXPECT_TRUE(ids.insert(m.id).second);
      EXPECT_EQ(m.distance, hamming_distance(queries[m.id - 1000].descriptor,
                                             features_.descriptors[m.feature]));
    }
    EXPECT_GT(matches.size(), 20u);
  }
}

TEST_F(MatcherTest, AmbiguousMatchesAreRefused) {
  Descriptor d{};
  add_feature(100, 100, {0xff, 0, 0, 0});   // distance 8
  add_feature(101, 100, {0x1ff, 0, 0, 0});  // distance 9
  EXPECT_THAT(near({query(0, d)}, {.ratio = 0.8}), IsEmpty());
  EXPECT_THAT(anywhere({query(0, d)}, {.ratio = 0.8}), IsEmpty());
  EXPECT_THAT(near({query(0, d)}, {.ratio = 0.9}), ElementsAre(Pairs(0u, 0u)));
}

TEST_F(MatcherTest, RivalOnAnotherLevelIsTheSamePointWhereThePlaceIsKnown) {
  Descriptor d{};
  add_feature(100, 100, {0xff, 0, 0, 0}, 2);
  add_feature(100, 100, {0x1ff, 0, 0, 0}, 3);
  EXPECT_THAT(near({query(0, d)}, {.ratio = 0.8}), ElementsAre(Pairs(0u, 0u)));
  EXPECT_THAT(anywhere({query(0, d)}, {.ratio = 0.8}), IsEmpty());
}

TEST_F(MatcherTest, MatchesThatTurnedUnlikeTheOthersAreDropped) {
  std::vector<Query> queries;
  const auto add = [&](float angle_then, float angle_now) {
    const Descriptor d = random_.descriptor();
    add_feature(100, 100, d, 0, angle_now);
    queries.push_back(query(static_cast<std::uint32_t>(queries.size()), d, angle_then));
  };
  for (int i = 0; i < 60; ++i) {  // a turn of 33 degrees, also across 360
    const auto angle = static_cast<float>(6 * i);
    add(angle, std::fmod(angle + 33.f, 360.f));
  }
  add(10, 250);
  add(200, 20);
  add(-1, 77);  // an unknown angle says nothing
  const auto matches = near(queries, {.consistent_angles = true});
  EXPECT_EQ(matches.size(), 61u);
  EXPECT_THAT(matches, testing::Not(testing::Contains(Pairs(60u, 60u))));
  EXPECT_THAT(matches, testing::Not(testing::Contains(Pairs(61u, 61u))));
  EXPECT_THAT(matches, testing::Contains(Pairs(62u, 62u)));
  EXPECT_EQ(near(queries).size(), 63u);
}

TEST_F(MatcherTest, FindsTheSamePointsInTwoViews) {
  TestWorld world;
  const View a = world.render(Pose::Identity()), b = world.render(walk(5));
  std::vector<Query> queries;
  for (std::uint32_t i = 0; i < a.point.size(); ++i)
    queries.push_back({.id = a.point[i],
                       .descriptor = a.features->descriptors[i],
                       .angle = a.features->keypoints[i].angle});
  const auto matches =
      match_anywhere(queries, *b.features, all,
                     {.max_distance = kStrictDistance, .ratio = 0.8, .consistent_angles = true});
  EXPECT_GT(matches.size(), 100u);
  for (const Match& m : matches) EXPECT_EQ(m.id, b.point[m.feature]);
}

TEST_F(MatcherTest, NothingInNothingOut) {
  EXPECT_THAT(near({}), IsEmpty());
  EXPECT_THAT(anywhere({}), IsEmpty());
  EXPECT_THAT(near({query(0, {})}, {.ratio = 0.8, .consistent_angles = true}), IsEmpty());
  EXPECT_THAT(anywhere({query(0, {})}, {.ratio = 0.8, .consistent_angles = true}), IsEmpty());
}

// A landmark straight ahead that was on level 2 at 3 m.
class PredictTest : public testing::Test {
 protected:
  PredictTest() { pyramid_.set_distance_range(landmark_, 2, 3.0); }
  std::optional<Query> from(const Pose& world_from_camera) const {
    return predict(landmark_, world_from_camera.inverse(), Camera{}, pyramid_, 4.0);
  }
  ScalePyramid pyramid_{Features{}};
  Landmark landmark_{.id = 9, .position_in_world = {0, 0, 3}, .mean_view = {0, 0, 1}};
};

TEST_F(PredictTest, PlaceAndLevelAtTheSameDistance) {
  const auto query = from(Pose::Identity());
  ASSERT_TRUE(query);
  EXPECT_EQ(query->id, 9u);
  EXPECT_DOUBLE_EQ(query->u, 319.5);
  EXPECT_DOUBLE_EQ(query->v, 239.5);
  EXPECT_LE(query->min_level, 2);
  EXPECT_GE(query->max_level, 2);
  EXPECT_NEAR(query->radius, 4.0 * 1.44, 1e-9);
}

TEST_F(PredictTest, FartherAwayOnFinerLevels) {
  const auto near = from(pose_at({0, 0, 1})), far = from(pose_at({0, 0, -1}));
  ASSERT_TRUE(near && far);
  EXPECT_GT(near->min_level, far->min_level);
  EXPECT_GT(near->radius, far->radius);
}

TEST_F(PredictTest, WiderWindowFromTheSide) {
  const auto front = from(Pose::Identity());
  const auto side = from(pose_at({1, 0, 0}, {0, -0.3, 0}));
  ASSERT_TRUE(front && side);
  EXPECT_GT(side->radius, front->radius);
}

TEST_F(PredictTest, NothingWhereItCannotBeSeen) {
  EXPECT_FALSE(from(pose_at({0, 0, 4}))) << "behind";
  EXPECT_FALSE(from(pose_at({0, 0, 3}))) << "in the camera";
  EXPECT_FALSE(from(pose_at({3, 0, 0}))) << "outside the image";
  EXPECT_FALSE(from(pose_at({0, 0, -20}))) << "too far";
  EXPECT_FALSE(from(pose_at({0, 0, 2.8}))) << "too near";
  EXPECT_FALSE(from(pose_at({2.9, 0, 2.5}, {0, -M_PI / 2 + 0.1, 0}))) << "from the side";
  EXPECT_FALSE(from(pose_at({0, 0, 6}, {0, M_PI, 0}))) << "from the back";
}

}  // namespace
}  // namespace stillpoint::orb_slam
