#include "map_voxel_cloud/voxel_cloud.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <string>

#include "map_voxel_cloud/voxel_cloud_backend.hpp"

namespace stillpoint::map_voxel_cloud {
namespace {

namespace fs = std::filesystem;

TEST(VoxelCloud, PointsOfAVoxelBecomeTheirMean) {
  VoxelCloud cloud(0.1);
  cloud.add({{0.01F, 0.01F, 0.01F}, {10, 20, 30}, 1});
  cloud.add({{0.03F, 0.05F, 0.09F}, {20, 40, 60}, 2});
  cloud.add({{0.05F, 0.03F, 0.02F}, {30, 60, 90}, 2});
  cloud.add({{-0.01F, 0.01F, 0.01F}, {1, 2, 3}, 7});
  const auto points = cloud.points();
  ASSERT_EQ(points.size(), 2U);
  EXPECT_TRUE(points[0].mean.position.isApprox(Eigen::Vector3f(0.03F, 0.03F, 0.04F), 1e-5F));
  EXPECT_THAT(points[0].mean.rgb, testing::ElementsAre(20, 40, 60));
  EXPECT_EQ(points[0].mean.label, 2);
  EXPECT_EQ(points[0].count, 3U);
  EXPECT_EQ(points[1].mean.label, 7);
}

TEST(VoxelCloud, CountsAreVotes) {
  VoxelCloud cloud(0.1);
  const auto add = [&](std::uint8_t label, std::uint32_t count) {
    cloud.add({.position = Eigen::Vector3f::Zero(), .label = label}, count);
  };
  add(4, 10);
  add(5, 3);
  EXPECT_EQ(cloud.points()[0].mean.label, 4);
  add(5, 12);
  EXPECT_EQ(cloud.points()[0].mean.label, 5);
  EXPECT_EQ(cloud.points()[0].count, 25U);
}

TEST(VoxelCloud, LeavesOutWhatIsNowhere) {
  VoxelCloud cloud(0.1);
  cloud.add({{std::numeric_limits<float>::quiet_NaN(), 0, 0}});
  cloud.add({{0, std::numeric_limits<float>::infinity(), 0}});
  cloud.add({{0, 0, -1e9F}});
  EXPECT_TRUE(cloud.points().empty());
}

// A wall two metres away, whose left half is class 3 and must not be mapped in its upper quarter.
DenseKeyFrame wall(KeyFrameId id, const Pose& world_from_camera) {
  auto frame = std::make_shared<Frame>();
  frame->camera = std::make_shared<Camera>();
  frame->depth = cv::Mat(480, 640, CV_32FC1, cv::Scalar(2.0));
  frame->bgr = cv::Mat(480, 640, CV_8UC3, cv::Scalar(10, 20, 30));
  auto segmentation = std::make_shared<Segmentation>();
  segmentation->labels = cv::Mat::zeros(480, 640, CV_8UC1);
  segmentation->labels.colRange(0, 320) = 3;
  auto weights = std::make_shared<StaticWeights>();
  weights->map = cv::Mat(480, 640, CV_8UC1, cv::Scalar(255));
  weights->map.rowRange(0, 120) = 0;
  return {.id = id,
          .frame = frame,
          .segmentation = segmentation,
          .weights = weights,
          .world_from_camera = world_from_camera};
}

StageContext context() {
  StageContext context;
  context.classes = named_classes("voc21");
  return context;
}

TEST(VoxelCloudBackend, SeesTheWallWhereItMayBeMapped) {
  VoxelCloudBackend map({.resolution = 0.05}, context());
  map.integrate(wall(0, Pose::Identity()));
  const auto points = map.points();
  EXPECT_GT(points.size(), 1000U);
  for (const VoxelPoint& point : points) {
    EXPECT_FLOAT_EQ(point.mean.position.z(), 2.0F);
    EXPECT_GT(point.mean.position.y(), 2.0 * (119.5 - 239.5) / 525.0 - 0.01);
    EXPECT_EQ(point.mean.label, point.mean.position.x() < 0 ? 3 : 0);
    EXPECT_THAT(point.mean.rgb, testing::ElementsAre(30, 20, 10));
  }
}

TEST(VoxelCloudBackend, KeyFramesWithoutLabelsHaveNoSayInTheClass) {
  VoxelCloudBackend map({}, context());
  map.integrate(wall(0, Pose::Identity()));
  for (KeyFrameId id = 1; id < 4; ++id) {
    DenseKeyFrame unlabelled = wall(id, Pose::Identity());
    unlabelled.segmentation = nullptr;
    map.integrate(unlabelled);
  }
  for (const VoxelPoint& point : map.points())
    EXPECT_EQ(point.mean.label, point.mean.position.x() < 0 ? 3 : 0);
}

TEST(VoxelCloudBackend, ClearedItIsEmpty) {
  VoxelCloudBackend map({}, context());
  map.integrate(wall(0, Pose::Identity()));
  map.clear();
  EXPECT_TRUE(map.points().empty());
}

TEST(VoxelCloudBackend, FollowsItsKeyFrames) {
  VoxelCloudBackend map({}, context());
  map.integrate(wall(0, Pose::Identity()));
  map.integrate(wall(1, Pose::Identity()));
  const std::size_t together = map.points().size();
  Pose moved = Pose::Identity();
  moved.translation().z() = 1.0;
  map.move(std::vector<MovedKeyFrame>{{1, moved}, {7, moved}});
  const auto points = map.points();
  EXPECT_NEAR(static_cast<double>(points.size()), 2.0 * together, 0.1 * together);
  for (const VoxelPoint& point : points)
    EXPECT_TRUE(std::abs(point.mean.position.z() - 2) < 1e-5 ||
                std::abs(point.mean.position.z() - 3) < 1e-5);
}

TEST(VoxelCloudBackend, WritesItsPoints) {
  const fs::path folder = fs::path(::testing::TempDir()) / "voxel_cloud_test";
  fs::create_directories(folder);
  VoxelCloudBackend map({}, context());
  map.integrate(wall(0, Pose::Identity()));
  map.save(folder);
  std::ifstream file(folder / "cloud.ply", std::ios::binary);
  const std::string ply(std::istreambuf_iterator<char>(file), {});
  const std::size_t count = map.points().size();
  EXPECT_THAT(ply, testing::HasSubstr("element vertex " + std::to_string(count) + "\n"));
  EXPECT_THAT(ply, testing::HasSubstr("comment label 15 person\n"));
  EXPECT_EQ(ply.size(), ply.find("end_header\n") + 11 + 16 * count);
  EXPECT_THROW(map.save("/proc/no_such_folder"), Error);
}

}  // namespace
}  // namespace stillpoint::map_voxel_cloud
