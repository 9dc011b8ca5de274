#include "stillpoint/runtime/map_check.hpp"

#include <gtest/gtest.h>

#include "doubles.hpp"

namespace stillpoint {
namespace {

using testing::CallLog;
using Strings = std::vector<std::string>;

struct MapCheckFixture {
  CallLog calls;
  TimeLog times;
  SparseMap map;
  std::shared_ptr<testing::FakeMapChecker> checker =
      std::make_shared<testing::FakeMapChecker>(calls);
  MapCheck check{{checker, "depth"}, RuntimeOptions(), times};

  MapEvidence at(std::uint32_t index) {
    frame = std::make_shared<const Frame>(testing::make_frame(index));
    return check.check(*frame, {}, map);
  }
  /// The camera is one metre farther along x in every frame.
  void tracked() {
    TrackedFrame result{.frame = frame, .weights = std::make_shared<const StaticWeights>()};
    result.world_from_camera = Pose(Eigen::Translation3d(frame->index, 0.0, 0.0));
    check.tracked(result, map);
  }

  FramePtr frame;
};

TEST(MapCheck, ComparesWhereTheCameraMayBe) {
  MapCheckFixture f;
  for (std::uint32_t i = 0; i < 3; ++i) {
    EXPECT_EQ(f.at(i).log_odds.empty(), i == 0) << "nothing was tracked before";
    f.tracked();
  }
  EXPECT_EQ(f.calls.entries("compare"), (Strings{"compare 1", "compare 2"}));
  EXPECT_EQ(f.calls.entries("remember"), (Strings{"remember 0", "remember 1"}));
  // With the velocity of before, and without motion.
  ASSERT_EQ(f.checker->last_guesses.size(), 4u);
  const std::vector<double> expected = {0.0, 0.0, 2.0, 1.0};
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_NEAR(f.checker->last_guesses[i], expected[i], 1e-6);
}

TEST(MapCheck, ALostCameraIsComparedWithNothing) {
  MapCheckFixture f;
  f.at(0);
  f.tracked();
  f.at(1);
  f.check.tracked(std::nullopt, f.map);
  EXPECT_TRUE(f.at(2).log_odds.empty());
  EXPECT_EQ(f.calls.entries("remember"), (Strings{"remember 0"}));
}

TEST(MapCheck, AFailureIsNamed) {
  MapCheckFixture f;
  f.calls.failing = "compare 1";
  f.at(0);
  f.tracked();
  try {
    f.at(1);
    FAIL() << "no exception";
  } catch (const StageError& error) {
    EXPECT_STREQ(error.what(), "map check (depth) failed on frame 1: out of ideas");
  }
}

TEST(MapCheck, WithoutACheckerNothingIsKnown) {
  TimeLog times;
  MapCheck check({}, RuntimeOptions(), times);
  EXPECT_FALSE(check.present());
  EXPECT_TRUE(check.check(testing::make_frame(0), {}, {}).log_odds.empty());
  EXPECT_TRUE(times.take().empty());
}

}  // namespace
}  // namespace stillpoint
