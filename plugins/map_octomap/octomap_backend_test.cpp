#include "map_octomap/octomap_backend.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <octomap/OcTree.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "semantic_octree/test_room.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint::map_octomap {
namespace {

using semantic_octree::looking;
using semantic_octree::SemanticVoxel;
using semantic_octree::TestRoom;

namespace fs = std::filesystem;
using Options = OctomapBackend::Options;

constexpr int kKeyFrames = 12;

Pose pose_of(KeyFrameId id) {
  const double s = id;
  return looking({0.4 * std::cos(0.5 * s), -0.6 + 0.3 * std::sin(0.7 * s), 1.31 + 0.01 * s},
                 0.55 * s);
}

// Where a camera that drifts believes to be.
Pose drifted_pose_of(KeyFrameId id) {
  Pose pose = pose_of(id);
  const double s = id;
  pose.translation() += 0.02 * s * Eigen::Vector3d(1, -0.5, 0.2);
  pose.rotate(Eigen::AngleAxisd(0.01 * s, Eigen::Vector3d::UnitY()));
  return pose;
}

DenseKeyFrame keyframe_at(KeyFrameId id, const Pose& believed) {
  static const TestRoom room;
  DenseKeyFrame keyframe = room.render(pose_of(id), id);
  keyframe.world_from_camera = believed;
  return keyframe;
}

StageContext context() {
  StageContext context;
  context.classes = named_classes("voc21");
  return context;
}

class OctomapBackendTest : public ::testing::Test {
 protected:
  static OctomapBackend map_at(Pose (*pose)(KeyFrameId), const Options& options = {}) {
    OctomapBackend map(options, context());
    for (KeyFrameId id = 0; id < kKeyFrames; ++id) map.integrate(keyframe_at(id, pose(id)));
    return map;
  }

  static std::vector<MovedKeyFrame> all_to(Pose (*pose)(KeyFrameId)) {
    std::vector<MovedKeyFrame> moved;
    for (KeyFrameId id = 0; id < kKeyFrames; ++id) moved.push_back({id, pose(id)});
    return moved;
  }

  static void expect_same(const SemanticOctree& one, const SemanticOctree& other) {
    ASSERT_EQ(one.size(), other.size());
    auto a = one.begin_tree();
    for (auto b = other.begin_tree(); b != other.end_tree(); ++a, ++b) {
      ASSERT_EQ(a.getKey(), b.getKey());
      ASSERT_TRUE(*a == *b) << a.getX() << ' ' << a.getY() << ' ' << a.getZ();
    }
  }

  fs::path folder() {
    const fs::path folder =
        fs::path(::testing::TempDir()) / ("octomap_backend_test_" + std::to_string(::getpid()));
    fs::remove_all(folder);
    fs::create_directories(folder);
    return folder;
  }
};

TEST_F(OctomapBackendTest, AfterACorrectionItIsTheMapOfTheCorrectedPoses) {
  OctomapBackend map = map_at(drifted_pose_of, {.tolerance = 0});
  map.move(all_to(pose_of));
  expect_same(map.tree(), map_at(pose_of).tree());
}

TEST_F(OctomapBackendTest, ClearedItIsANewMap) {
  OctomapBackend map = map_at(drifted_pose_of);
  map.clear();
  EXPECT_TRUE(map.occupied().empty());
  for (KeyFrameId id = 0; id < kKeyFrames; ++id) map.integrate(keyframe_at(id, pose_of(id)));
  map.move(all_to(pose_of));
  expect_same(map.tree(), map_at(pose_of).tree());
}

TEST_F(OctomapBackendTest, AfterSomeHaveMovedTheOthersStay) {
  const auto corrected_in_part = [](KeyFrameId id) {
    return id >= 5 && id < 8 ? pose_of(id) : drifted_pose_of(id);
  };
  OctomapBackend map = map_at(drifted_pose_of);
  map.move(std::vector<MovedKeyFrame>{{5, pose_of(5)}, {6, pose_of(6)}, {7, pose_of(7)}});
  expect_same(map.tree(), map_at(corrected_in_part).tree());
}

TEST_F(OctomapBackendTest, SmallMovesWaitUntilItIsSaved) {
  const auto nudged = [](KeyFrameId id) {
    Pose pose = pose_of(id);
    pose.translation().x() += 0.005;
    return pose;
  };
  OctomapBackend map = map_at(nudged);
  map.move(all_to(pose_of));
  expect_same(map.tree(), map_at(nudged).tree());
  map.save(folder());
  expect_same(map.tree(), map_at(pose_of).tree());
}

// Where poses never settle: 23 scans were made, which is the share of two key frames.
TEST_F(OctomapBackendTest, AfterFusingAgainItRestsForAFewKeyFrames) {
  OctomapBackend map = map_at(drifted_pose_of);
  map.move(all_to(pose_of));
  map.move(all_to(drifted_pose_of));
  expect_same(map.tree(), map_at(pose_of).tree());
  OctomapBackend expected = map_at(drifted_pose_of);
  for (KeyFrameId id = kKeyFrames; id < kKeyFrames + 2; ++id) {
    map.integrate(keyframe_at(id, pose_of(id)));
    expected.integrate(keyframe_at(id, pose_of(id)));
  }
  map.move({});
  expect_same(map.tree(), expected.tree());
}

TEST_F(OctomapBackendTest, WhatIsSavedNeverRests) {
  OctomapBackend map = map_at(drifted_pose_of);
  map.move(all_to(pose_of));
  map.move(all_to(drifted_pose_of));
  map.save(folder());
  expect_same(map.tree(), map_at(drifted_pose_of).tree());
}

TEST_F(OctomapBackendTest, KeyFramesThatItNeverSawMoveNothing) {
  OctomapBackend map = map_at(pose_of);
  map.move(std::vector<MovedKeyFrame>{{100, pose_of(3)}});
  expect_same(map.tree(), map_at(pose_of).tree());
}

TEST_F(OctomapBackendTest, WhatMustNotBeMappedIsNotThere) {
  OctomapBackend with({}, context()), without({}, context());
  DenseKeyFrame keyframe = TestRoom().render(looking({0.5, -1.0, 1.3}, 0.0));
  with.integrate(keyframe);
  auto weights = std::make_shared<StaticWeights>();
  weights->map = (keyframe.segmentation->labels == 0);
  keyframe.weights = weights;
  without.integrate(keyframe);
  const auto on_pillar = [](const OctomapBackend& map) {
    return map.tree().search(0.52, 0.735, 1.3);
  };
  ASSERT_TRUE(on_pillar(with));
  EXPECT_TRUE(with.tree().isNodeOccupied(on_pillar(with)));
  EXPECT_EQ(on_pillar(without), nullptr);
  // What is before it is free.
  ASSERT_TRUE(without.tree().search(0.52, 0.3, 1.3));
  EXPECT_FALSE(without.tree().isNodeOccupied(without.tree().search(0.52, 0.3, 1.3)));
}

TEST_F(OctomapBackendTest, BesideWhatMovesOneLookIsNotEnough) {
  OctomapBackend map({}, context()), without_margin({.margin = 0}, context());
  DenseKeyFrame keyframe = TestRoom().render(looking({0.5, -1.0, 1.3}, 0.0));
  auto weights = std::make_shared<StaticWeights>();  // of the pillar only the left half is found
  weights->map = cv::Mat(keyframe.frame->depth.size(), CV_8UC1, cv::Scalar(255));
  weights->map.colRange(0, 160).setTo(0, keyframe.segmentation->labels.colRange(0, 160) != 0);
  keyframe.weights = weights;
  map.integrate(keyframe);
  without_margin.integrate(keyframe);
  const Eigen::Vector3d beside(0.525, 0.735, 1.325), far(0.675, 0.775, 1.325),
      wall(-0.5, 2.425, 1.3);
  const auto occupied = [](const OctomapBackend& backend, const Eigen::Vector3d& at) {
    return backend.tree().is_occupied(backend.tree().coordToKey(at.x(), at.y(), at.z()));
  };
  EXPECT_TRUE(occupied(without_margin, beside));
  EXPECT_FALSE(occupied(map, beside));
  EXPECT_TRUE(occupied(map, far));
  EXPECT_TRUE(occupied(map, wall));
  map.integrate(keyframe);
  EXPECT_TRUE(occupied(map, beside));
}

TEST_F(OctomapBackendTest, ThePapersModelKnowsNoFreeSpace) {
  OctomapBackend map = map_at(pose_of, {.model = Options::Model::kHits});
  for (auto leaf = map.tree().begin_leafs(); leaf != map.tree().end_leafs(); ++leaf)
    ASSERT_TRUE(map.tree().isNodeOccupied(*leaf));
}

TEST_F(OctomapBackendTest, SurfacesBeyondTheRangeAreLeftOut) {
  OctomapBackend map({.range = 2.0}, context());
  map.integrate(keyframe_at(0, pose_of(0)));
  for (auto leaf = map.tree().begin_leafs(); leaf != map.tree().end_leafs(); ++leaf)
    if (map.tree().isNodeOccupied(*leaf)) {
      const Eigen::Vector3d at(leaf.getX(), leaf.getY(), leaf.getZ());
      ASSERT_LT((at - pose_of(0).translation()).norm(), 2.0 + 0.05);
    }
  EXPECT_GT(map.tree().size(), 1000U);
}

TEST_F(OctomapBackendTest, APoseOutOfReachIsAnError) {
  OctomapBackend map({}, context());
  Pose far = pose_of(0);
  far.translation().x() = 2000;
  EXPECT_THROW(map.integrate(keyframe_at(0, far)), Error);
  far.translation().x() = std::nan("");
  EXPECT_THROW(map.integrate(keyframe_at(0, far)), Error);
  far = pose_of(0);
  far.linear()(1, 2) = std::nan("");
  EXPECT_THROW(map.integrate(keyframe_at(0, far)), Error);
}

TEST_F(OctomapBackendTest, FilesHoldTheMap) {
  OctomapBackend map = map_at(pose_of);
  const fs::path files = folder();
  map.save(files);
  const SemanticOctree& tree = map.tree();

  std::ifstream file(files / "map.ot", std::ios::binary);
  const std::unique_ptr<octomap::AbstractOcTree> read(octomap::AbstractOcTree::read(file));
  ASSERT_TRUE(dynamic_cast<octomap::ColorOcTree*>(read.get()));
  EXPECT_EQ(read->size(), tree.size());
  std::string line;
  std::getline(file, line);
  EXPECT_EQ(line, "# stillpoint classes 1");
  std::getline(file, line);
  EXPECT_EQ(nlohmann::json::parse(line)["names"][9], "chair");
  EXPECT_EQ(nlohmann::json::parse(line)["colors"][15], nlohmann::json({192, 128, 128}));
  const std::string classes(std::istreambuf_iterator<char>(file), {});
  ASSERT_EQ(classes.size(), 2 * tree.getNumLeafNodes());
  std::size_t i = 0;
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf, i += 2)
    ASSERT_EQ(static_cast<std::uint8_t>(classes[i]), leaf->classes().best());

  octomap::OcTree binary((files / "map.bt").string());
  std::size_t occupied = 0;
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    const octomap::OcTreeNode* node = binary.search(leaf.getKey());
    ASSERT_TRUE(node);
    ASSERT_EQ(binary.isNodeOccupied(node), tree.isNodeOccupied(*leaf));
    if (tree.isNodeOccupied(*leaf))
      occupied += std::size_t{1} << (3 * (tree.getTreeDepth() - leaf.getDepth()));
  }

  std::ifstream ply(files / "map.ply", std::ios::binary);
  const std::string cloud(std::istreambuf_iterator<char>(ply), {});
  EXPECT_THAT(cloud, ::testing::HasSubstr("element vertex " + std::to_string(occupied) + "\n"));
  EXPECT_THAT(cloud, ::testing::HasSubstr("comment label 9 chair\n"));
  const std::size_t header = cloud.find("end_header\n") + 11;
  EXPECT_EQ(cloud.size(), header + 16 * occupied);
  float first[3];
  std::memcpy(first, cloud.data() + header, sizeof first);
  const SemanticVoxel* voxel = tree.search(first[0], first[1], first[2]);
  ASSERT_TRUE(voxel);
  EXPECT_TRUE(tree.isNodeOccupied(voxel));
}

TEST_F(OctomapBackendTest, AFolderThatIsNoneIsAnError) {
  OctomapBackend map = map_at(pose_of);
  EXPECT_THROW(map.save("/proc/no_such_folder"), Error);
}

TEST_F(OctomapBackendTest, KeyFramesWithoutLabelsHaveNoSayInTheClass) {
  OctomapBackend labelled({}, {}), mixed({}, {});
  for (KeyFrameId id = 0; id < 4; ++id) {
    DenseKeyFrame keyframe = TestRoom().render(pose_of(0), id);
    if (id == 0) labelled.integrate(keyframe);
    if (id > 0) keyframe.segmentation = nullptr;
    mixed.integrate(keyframe);
  }
  int classes = 0;
  for (auto leaf = labelled.tree().begin_leafs(); leaf != labelled.tree().end_leafs(); ++leaf) {
    if (!leaf->classes().known()) continue;
    const SemanticVoxel* same = mixed.tree().search(leaf.getKey());
    ASSERT_TRUE(same);
    EXPECT_EQ(same->classes(), leaf->classes());
    classes += leaf->classes().best() > 0;
  }
  EXPECT_GT(classes, 100);
}

TEST_F(OctomapBackendTest, WithoutKeyFramesThereIsNoMap) {
  std::vector<std::string> warnings;
  StageContext context;
  context.log = [&](LogLevel, std::string_view text) { warnings.emplace_back(text); };
  const testing::TemporaryFolder folder;
  OctomapBackend({}, context).save(folder.path());
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  EXPECT_THAT(warnings, ::testing::ElementsAre(::testing::HasSubstr("no key frame")));
}

TEST_F(OctomapBackendTest, ATooWideCostMapIsLeftOut) {
  std::vector<std::string> warnings;
  StageContext context;
  context.log = [&](LogLevel, std::string_view text) { warnings.emplace_back(text); };
  OctomapBackend::Options options;
  options.cost_map.floor = {0, 0, 1, 0};
  OctomapBackend map(options, context);
  Pose far_away = pose_of(0);
  far_away.translation() += Eigen::Vector3d(900, 900, 0);
  map.integrate(TestRoom().render(pose_of(0), 0));
  DenseKeyFrame lost = TestRoom().render(pose_of(0), 1);
  lost.world_from_camera = far_away;
  map.integrate(lost);
  const testing::TemporaryFolder folder;
  map.save(folder.path());
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "map.ot"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "map.pgm"));
  EXPECT_THAT(warnings, ::testing::ElementsAre(::testing::HasSubstr("too wide")));
}

}  // namespace
}  // namespace stillpoint::map_octomap
