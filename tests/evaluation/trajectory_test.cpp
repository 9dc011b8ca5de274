#include "evaluation/trajectory.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "fixtures.hpp"
#include "stillpoint/error.hpp"

namespace stillpoint::evaluation {
namespace {

using testing::HasSubstr;

std::string message_for(const std::string& text) {
  const TemporaryFile file("bad.txt", text);
  try {
    read_trajectory(file.path());
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kData);
    return error.what();
  }
  return "no error";
}

constexpr const char* kGood = "1.5 1 2 3 0 0 0 1\n";

TEST(Trajectory, ReadsCommentsTabsCommasAndWindowsLineEnds) {
  const TemporaryFile file("good.txt",
                           "# time tx …\r\n\n 1.5 1 2 3 0 0 0 2\r\n2.5,4,5\t6,0 0 1 1\n");
  const Trajectory t = read_trajectory(file.path());
  ASSERT_EQ(t.poses.size(), 2u);
  EXPECT_EQ(t.start(), 1.5);
  EXPECT_TRUE(t.poses[0].world_from_camera.linear().isIdentity(1e-15));
  EXPECT_EQ(t.poses[1].world_from_camera.translation(), Eigen::Vector3d(4, 5, 6));
  EXPECT_NEAR(rotation_angle(t.poses[1].world_from_camera), M_PI / 2, 1e-12);
}

TEST(Trajectory, LastOfSeveralPosesWithOneTimeCounts) {
  const TemporaryFile file("repeated.txt", std::string(kGood) + "1.5 7 2 3 0 0 0 1\n");
  const Trajectory t = read_trajectory(file.path());
  ASSERT_EQ(t.poses.size(), 1u);
  EXPECT_EQ(t.repeated_stamps, 1);
  EXPECT_EQ(t.poses[0].world_from_camera.translation().x(), 7);
}

TEST(Trajectory, EveryFaultNamesFileAndLine) {
  const std::string good = kGood;
  EXPECT_THAT(message_for(good + "2.5 1 2 3 0 0 0\n"), HasSubstr("bad.txt:2: expected 8 columns"));
  EXPECT_THAT(message_for(good + "2.5\n"), HasSubstr("bad.txt:2: expected 8 columns, found 1"));
  EXPECT_THAT(message_for("1 2 x 3 0 0 0 1\n"), HasSubstr("bad.txt:1: 'x' is not a number"));
  EXPECT_THAT(message_for("1 2 1.5m 3 0 0 0 1\n"), HasSubstr("'1.5m' is not a number"));
  EXPECT_THAT(message_for(good + "2.5 nan 2 3 0 0 0 1\n"), HasSubstr("bad.txt:2: 'nan' is not a"));
  EXPECT_THAT(message_for(good + "2.5 1 2 3 0 0 0 0\n"), HasSubstr("bad.txt:2: the quaternion"));
  EXPECT_THAT(message_for(good + "2.5 1 2 3 0 0 1e300 1\n"),
              HasSubstr("bad.txt:2: the quaternion"));
  EXPECT_THAT(message_for(good + "0.5 1 2 3 0 0 0 1\n"), HasSubstr("bad.txt:2: the time is earl"));
  EXPECT_THAT(message_for(good + "2.5 1e300 2 3 0 0 0 1\n"), HasSubstr("bad.txt:2: the position"));
  EXPECT_THAT(message_for(good + std::string(100'000, '7')), HasSubstr("bad.txt: a line is too"));
  EXPECT_THAT(message_for("# only a comment\n"), HasSubstr("bad.txt: the file holds no data line"));
}

TEST(Trajectory, NanosecondsOfEurocAreNoSeconds) {
  // A turn of 90° about z: EuRoC's files begin with w, the trajectories of ORB-SLAM3 end with it.
  const TemporaryFile euroc(
      "euroc.csv",
      "#timestamp, p_RS_R_x [m], …\n"
      "1403636580838555648,1,2,3,0.70710678,0,0,0.70710678,0,0,0,0,0,0,0,0,0\n"
      "1403636580843555328,1,2,3,0.70710678,0,0,0.70710678,0,0,0,0,0,0,0,0,0\n");
  const TemporaryFile vicon("vicon.csv", "1403636580838555648,1,2,3,0.70710678,0,0,0.70710678\n");
  const TemporaryFile orb("orb.txt", "1403636580838555648.0 1 2 3 0 0 0.70710678 0.70710678\n");
  for (const TemporaryFile* file : {&euroc, &vicon, &orb}) {
    const Trajectory t = read_trajectory(file->path());
    EXPECT_NEAR(t.start(), 1403636580.838555648, 1e-6);
    EXPECT_EQ(t.poses[0].world_from_camera.translation(), Eigen::Vector3d(1, 2, 3));
    EXPECT_TRUE((t.poses[0].world_from_camera.linear() * Eigen::Vector3d::UnitX())
                    .isApprox(Eigen::Vector3d::UnitY(), 1e-7));
  }
  EXPECT_NEAR(read_trajectory(euroc.path()).duration(), 0.00499968, 1e-6);
}

TEST(Trajectory, NanosecondsSinceTheClockBeganAreNoSeconds) {
  const TemporaryFile file("boot.csv",
                           "#timestamp [ns], p_RS_R_x [m], …\n"
                           "5000000000,1,2,3,0.70710678,0,0,0.70710678\n"
                           "9900000000,1,2,3,0.70710678,0,0,0.70710678\n"
                           "11500000000,1,2,3,0.70710678,0,0,0.70710678\n");
  const Trajectory t = read_trajectory(file.path());
  EXPECT_NEAR(t.start(), 5.0, 1e-9);
  EXPECT_NEAR(t.duration(), 6.5, 1e-9);
  EXPECT_TRUE((t.poses[0].world_from_camera.linear() * Eigen::Vector3d::UnitX())
                  .isApprox(Eigen::Vector3d::UnitY(), 1e-7));
  const TemporaryFile seconds("seconds.csv",
                              "5,1,2,3,0,0,0.70710678,0.70710678\n"
                              "6,1,2,3,0,0,0.70710678,0.70710678\n");
  EXPECT_NEAR(read_trajectory(seconds.path()).start(), 5.0, 1e-9);
}

TEST(Trajectory, PipesAreNotWaitedFor) {
  const TemporaryFile file("pipe", "");
  std::filesystem::remove(file.path());
  ASSERT_EQ(::mkfifo(file.path().c_str(), 0600), 0);
  EXPECT_THROW(read_trajectory(file.path()), Error);
  EXPECT_THROW(read_trajectory("/dev/zero"), Error);
}

TEST(Trajectory, NanosecondsMayBeginWithTheMachine) {
  const TemporaryFile two_minutes("boot.csv", "120000000000,1,2,3,0.70710678,0,0,0.70710678\n");
  const TemporaryFile at_once("begin.csv",
                              "1500000000,1,2,3,0.70710678,0,0,0.70710678,0,0,0,0,0,0,0,0,0\n");
  EXPECT_DOUBLE_EQ(read_trajectory(two_minutes.path()).start(), 120.0);
  EXPECT_DOUBLE_EQ(read_trajectory(at_once.path()).start(), 1.5);
  const TemporaryFile both("both.csv",
                           "95000000000,1,2,3,0.70710678,0,0,0.70710678\n"
                           "105000000000,1,2,3,0.70710678,0,0,0.70710678\n");
  EXPECT_DOUBLE_EQ(read_trajectory(both.path()).start(), 95.0);
  EXPECT_NEAR(read_trajectory(two_minutes.path()).poses[0].world_from_camera.linear()(1, 0), 1.0,
              1e-7);
}

TEST(Trajectory, MatricesOfKittiAreTenPosesASecond) {
  const TemporaryFile file("kitti.txt",
                           "1 0 0 0 0 1 0 0 0 0 1 0\n"
                           "0 -1 0 4 1 0 0 5 0 0 1 6\n");
  const Trajectory t = read_trajectory(file.path());
  ASSERT_EQ(t.poses.size(), 2u);
  EXPECT_EQ(t.start(), 0.0);
  EXPECT_NEAR(t.end(), 0.1, 1e-12);
  EXPECT_EQ(t.poses[1].world_from_camera.translation(), Eigen::Vector3d(4, 5, 6));
  EXPECT_TRUE((t.poses[1].world_from_camera.linear() * Eigen::Vector3d::UnitX())
                  .isApprox(Eigen::Vector3d::UnitY(), 1e-12));
  EXPECT_THAT(message_for("1 0 0 0 0 2 0 0 0 0 1 0\n"),
              HasSubstr("bad.txt:1: these 12 numbers are no pose"));
  EXPECT_THAT(message_for("1 0 0 0 0 1 0 0 0 0 1 0\n" + std::string(kGood)),
              HasSubstr("bad.txt:2: expected 12 columns, as in the lines before, found 8"));
}

TEST(Trajectory, MissingFileAndFolderAreNamed) {
  EXPECT_THROW(read_trajectory("no/such/file.txt"), Error);
  EXPECT_THROW(read_trajectory(STILLPOINT_BINARY_DIR), Error);
  EXPECT_THROW(read_trajectory("/dev/zero"), Error);
}

TEST(Trajectory, StampsAreTheFirstColumnOfAnyList) {
  const TemporaryFile file("rgb.txt",
                           "# color images\n1.5 rgb/a.png 1.6 depth/a.png\n2.5 rgb/b.png\n");
  EXPECT_THAT(read_stamps(file.path()), testing::ElementsAre(1.5, 2.5));
}

}  // namespace
}  // namespace stillpoint::evaluation
