#include "semantic_octree/semantic_octree.hpp"

#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include <memory>
#include <sstream>
#include <vector>

#include "semantic_octree/test_room.hpp"

namespace stillpoint::semantic_octree {
namespace {

constexpr double kResolution = 0.05;

// OctoMap's defaults.
const OccupancyModel kOctomapModel = [] {
  const octomap::OcTree tree(kResolution);
  return OccupancyModel{.hit = tree.getProbHitLog(),
                        .miss = tree.getProbMissLog(),
                        .min = tree.getClampingThresMinLog(),
                        .max = tree.getClampingThresMaxLog()};
}();

std::vector<Pose> around_the_room() {
  std::vector<Pose> poses;
  for (int i = 0; i < 12; ++i)
    poses.push_back(looking(
        {0.4 * std::cos(0.5 * i), -0.6 + 0.3 * std::sin(0.7 * i), 1.31 + 0.01 * i}, 0.55 * i));
  return poses;
}

SemanticOctree map_of(const TestRoom& room, const std::vector<Pose>& poses) {
  SemanticOctree tree(kResolution);
  ScanBricks scan({.resolution = kResolution, .range = 6.0});
  for (const Pose& pose : poses) {
    scan.scan(room.render(pose));
    tree.add(scan, scan.bricks(), kOctomapModel);
  }
  return tree;
}

octomap::OcTree map_by_octomap(const TestRoom& room, const std::vector<Pose>& poses) {
  octomap::OcTree tree(kResolution);
  for (const Pose& pose : poses) {
    const DenseKeyFrame keyframe = room.render(pose);
    octomap::Pointcloud cloud;
    for (int v = 0; v < keyframe.frame->depth.rows; ++v)
      for (int u = 0; u < keyframe.frame->depth.cols; ++u) {
        const Eigen::Vector3f p =
            (pose * keyframe.frame->camera->unproject(u, v, keyframe.frame->depth.at<float>(v, u)))
                .cast<float>();
        cloud.push_back(p.x(), p.y(), p.z());
      }
    const Eigen::Vector3f eye = pose.translation().cast<float>();
    tree.insertPointCloud(cloud, {eye.x(), eye.y(), eye.z()}, -1, false, true);
  }
  return tree;
}

TEST(SemanticOctree, IsTheSameAsOctomapsOwn) {
  const TestRoom room;
  SemanticOctree ours = map_of(room, around_the_room());
  octomap::OcTree theirs = map_by_octomap(room, around_the_room());
  EXPECT_EQ(ours.size(), ours.calcNumNodes());
  ours.expand();
  theirs.expand();
  std::size_t same = 0, all = 0;
  for (auto leaf = theirs.begin_leafs(); leaf != theirs.end_leafs(); ++leaf, ++all) {
    const SemanticVoxel* voxel = ours.search(leaf.getKey());
    same += voxel && std::abs(voxel->getLogOdds() - leaf->getLogOdds()) < 1e-4;
  }
  EXPECT_GT(all, 100'000);
  EXPECT_GT(same, 0.999 * all);  // rounding at the borders of voxels
  EXPECT_NEAR(ours.getNumLeafNodes(), all, 0.0005 * all);
}

TEST(SemanticOctree, InnerNodesStandForTheirChildren) {
  SemanticOctree tree = map_of({}, around_the_room());
  for (auto node = tree.begin_tree(); node != tree.end_tree(); ++node) {
    if (node.isLeaf()) continue;
    float most = -10;
    for (unsigned i = 0; i < 8; ++i)
      if (tree.nodeChildExists(&*node, i))
        most = std::max(most, tree.getNodeChild(&*node, i)->getLogOdds());
    ASSERT_EQ(node->getLogOdds(), most);
    ASSERT_FALSE(tree.isNodeCollapsible(&*node));
  }
}

TEST(SemanticOctree, SurfacesHaveColorAndClass) {
  SemanticOctree tree = map_of({}, std::vector<Pose>(3, looking({0.5, -1.0, 1.3}, 0.0)));
  const SemanticVoxel* pillar = tree.search(0.52, 0.735, 1.2);
  ASSERT_TRUE(pillar);
  EXPECT_GT(pillar->getOccupancy(), 0.9);
  EXPECT_EQ(pillar->classes().best(), kPillar.label);
  EXPECT_EQ(pillar->classes().confidence(), 1.0);
  EXPECT_EQ(pillar->getColor(), octomap::ColorOcTreeNode::Color(210, 40, 30));
  const SemanticVoxel* floor = tree.search(-0.5, 2.0, 0.02);
  ASSERT_TRUE(floor);
  EXPECT_TRUE(floor->classes().known());
  EXPECT_EQ(floor->classes().best(), kFloor.label);
}

TEST(SemanticOctree, WhatIsGoneIsForgotten) {
  const Pose pose = looking({0.5, -1.0, 1.3}, 0.0);
  TestRoom room;
  SemanticOctree tree(kResolution);
  ScanBricks scan({.resolution = kResolution, .range = 6.0});
  const auto add = [&] {
    scan.scan(room.render(pose));
    tree.add(scan, scan.bricks(), kOctomapModel);
  };
  for (int i = 0; i < 3; ++i) add();
  EXPECT_TRUE(tree.isNodeOccupied(tree.search(0.52, 0.735, 1.3)));
  room.pillar = false;
  for (int i = 0; i < 12; ++i) add();
  const SemanticVoxel* gone = tree.search(0.52, 0.735, 1.3);
  ASSERT_TRUE(gone);
  EXPECT_FALSE(tree.isNodeOccupied(gone));
  EXPECT_FALSE(gone->classes().known());
  EXPECT_FALSE(gone->isColorSet());
}

TEST(SemanticOctree, WithoutCarvingNothingIsEverFree) {
  SemanticOctree tree(kResolution);
  ScanBricks scan({.resolution = kResolution, .range = 6.0, .carve = false});
  scan.scan(TestRoom().render(looking({0.5, -1.0, 1.3}, 0.0)));
  tree.add(scan, scan.bricks(), kOctomapModel);
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf)
    ASSERT_GT(leaf->getLogOdds(), 0);
  EXPECT_EQ(tree.search(0.5, 0.0, 1.3), nullptr);
}

TEST(SemanticOctree, FreeSpaceIsPruned) {
  SemanticOctree tree = map_of({}, {looking({0.5, -1.0, 1.3}, 0.0)});
  const std::size_t leaves = tree.getNumLeafNodes();
  tree.expand();
  EXPECT_LT(leaves, tree.getNumLeafNodes() / 3);
}

TEST(SemanticOctree, OctomapReadsItsFiles) {
  SemanticOctree tree = map_of({}, around_the_room());
  std::stringstream file;
  ASSERT_TRUE(tree.write(file));
  const std::unique_ptr<octomap::AbstractOcTree> read(octomap::AbstractOcTree::read(file));
  const auto* colored = dynamic_cast<octomap::ColorOcTree*>(read.get());
  ASSERT_TRUE(colored);
  EXPECT_EQ(colored->size(), tree.size());
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    const octomap::ColorOcTreeNode* node = colored->search(leaf.getKey(), leaf.getDepth());
    ASSERT_TRUE(node);
    ASSERT_EQ(node->getLogOdds(), leaf->getLogOdds());
    ASSERT_EQ(node->getColor(), leaf->getColor());
  }
}

// A wall 3 m away. Where free space ends, nothing is known up to the wall.
TEST(SemanticOctree, FreeSpaceEndsStandardDeviationsBeforeASurface) {
  constexpr double kEye = 0.02;  // m; the wall is not between two voxels
  for (const double noise : {0.002, 0.02}) {
    SCOPED_TRACE(noise);
    auto camera = std::make_shared<Camera>(
        Camera{.width = 64, .height = 48, .fx = 60, .fy = 60, .cx = 31.5, .cy = 23.5});
    camera->surface_noise = noise;
    auto frame = std::make_shared<Frame>();
    frame->camera = camera;
    frame->depth = cv::Mat(48, 64, CV_32FC1, cv::Scalar(3));
    frame->bgr = cv::Mat::zeros(48, 64, CV_8UC3);
    ScanBricks scan({.resolution = kResolution, .range = 6.0, .sigmas_before_surface = 2.0});
    scan.scan({.frame = frame, .world_from_camera = looking({kEye, kEye, kEye}, 0)});
    SemanticOctree tree(kResolution);
    tree.add(scan, scan.bricks(), kOctomapModel);
    const auto voxel = [&](double distance) { return tree.search(kEye, kEye + distance, kEye); };
    const double end = 3 - 2 * noise * 3 * 3;
    ASSERT_TRUE(voxel(end - 0.06));
    EXPECT_LT(voxel(end - 0.06)->getLogOdds(), 0);
    for (double distance = end; distance < 2.97; distance += kResolution)
      EXPECT_FALSE(voxel(distance)) << distance;
    ASSERT_TRUE(voxel(3));
    EXPECT_GT(voxel(3)->getLogOdds(), 0);
  }
}

TEST(SemanticOctree, NothingSeenChangesNothing) {
  SemanticOctree tree(kResolution);
  ScanBricks scan({.resolution = kResolution});
  DenseKeyFrame keyframe = TestRoom().render(looking({0, 0, 1}, 0));
  auto blind = std::make_shared<Frame>(*keyframe.frame);
  blind->depth = cv::Mat::zeros(keyframe.frame->depth.size(), CV_32FC1);
  keyframe.frame = blind;
  scan.scan(keyframe);
  tree.add(scan, scan.bricks(), kOctomapModel);
  EXPECT_EQ(tree.size(), 0U);
}

}  // namespace
}  // namespace stillpoint::semantic_octree
