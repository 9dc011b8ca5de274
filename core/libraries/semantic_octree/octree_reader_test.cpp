#include "semantic_octree/octree_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>
#include <sys/stat.h>

#include <fstream>
#include <iterator>

#include "semantic_octree/test_map.hpp"
#include "stillpoint/error.hpp"
#include "support/error_text.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint::semantic_octree {
namespace {

namespace fs = std::filesystem;

class OctreeReader : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    map_ = std::make_unique<TestMap>(TestRoom());
    folder_ = std::make_unique<testing::TemporaryFolder>();
    map_->save(folder());
  }
  static void TearDownTestSuite() {
    folder_.reset();
    map_.reset();
  }

  static std::string contents(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  static fs::path written(const std::string& contents) {
    const fs::path file = folder() / "changed.ot";
    std::ofstream(file, std::ios::binary) << contents;
    return file;
  }
  static std::string message_for(const fs::path& file) {
    try {
      read_octree(file);
    } catch (const Error& error) {
      EXPECT_EQ(error.fault(), Fault::kData);
      return error.what();
    }
    return "no error";
  }

  static inline std::unique_ptr<TestMap> map_;
  static fs::path folder() { return folder_->path(); }

  static inline std::unique_ptr<testing::TemporaryFolder> folder_;
};

TEST_F(OctreeReader, AMapComesBackAsItWas) {
  const SavedOctree saved = read_octree(folder() / "map.ot");
  EXPECT_TRUE(saved.has_colors);
  EXPECT_EQ(saved.classes.names, named_classes("voc21"));
  EXPECT_EQ(saved.classes.colors[9], color_of_class(9));
  const SemanticOctree& tree = map_->tree();
  ASSERT_EQ(saved.tree->size(), tree.size());
  EXPECT_EQ(saved.tree->getResolution(), tree.getResolution());
  auto read = saved.tree->begin_tree();
  for (auto node = tree.begin_tree(); node != tree.end_tree(); ++node, ++read) {
    ASSERT_EQ(read.getKey(), node.getKey());
    ASSERT_EQ(read->getLogOdds(), node->getLogOdds());
    ASSERT_EQ(read->getColor(), node->getColor());
    if (tree.nodeHasChildren(&*node)) continue;
    ASSERT_EQ(read->classes().best(), node->classes().best());
    ASSERT_NEAR(read->classes().confidence(), node->classes().confidence(), 0.005);
  }
}

TEST_F(OctreeReader, SavingItAgainGivesTheSameFile) {
  const SavedOctree saved = read_octree(folder() / "map.ot");
  write_octree(*saved.tree, saved.classes, folder() / "again.ot");
  EXPECT_EQ(contents(folder() / "again.ot"), contents(folder() / "map.ot"));
}

TEST_F(OctreeReader, TheThresholdComesBack) {
  const testing::TemporaryFolder files;
  const TestMap strict({}, {.occupied_above = 0.9});
  strict.save(files.path());
  const SavedOctree saved = read_octree(files.path() / "map.ot");
  for (auto leaf = strict.tree().begin_leafs(); leaf != strict.tree().end_leafs(); ++leaf)
    ASSERT_EQ(saved.tree->isNodeOccupied(saved.tree->search(leaf.getKey(), leaf.getDepth())),
              strict.tree().isNodeOccupied(*leaf));
  write_octree(*saved.tree, saved.classes, files.path() / "again.ot");
  EXPECT_EQ(contents(files.path() / "again.ot"), contents(files.path() / "map.ot"));
}

TEST_F(OctreeReader, AnEmptyMapIsSaid) {
  const SemanticOctree empty(0.05);
  write_octree(empty, {}, folder() / "empty.ot");
  EXPECT_THAT(message_for(folder() / "empty.ot"), ::testing::HasSubstr("holds no voxel"));
}

// A leaf high up in the tree stands for more voxels than there is memory.
TEST_F(OctreeReader, HugeLeavesAreRefused) {
  std::string file = "# Octomap OcTree file\nid OcTree\nsize 2\nres 0.05\ndata\n";
  const float log_odds = 1;
  for (const char children : {'\1', '\0'}) {
    file.append(reinterpret_cast<const char*>(&log_odds), sizeof log_odds);
    file.push_back(children);
  }
  EXPECT_THAT(message_for(written(file)), ::testing::HasSubstr("a leaf of"));
}

// Free space: eight nodes for two bytes.
TEST_F(OctreeReader, MoreNodesThanMemoryAreRefused) {
  const fs::path file = written(
      "# Octomap OcTree binary file\nid OcTree\nsize 9\nres 0.05\ndata\n" + std::string(2, '\x55'));
  const auto message = [&](std::size_t most_memory) {
    return testing::error_text(Fault::kData, [&] { read_octree(file, most_memory); });
  };
  EXPECT_THAT(message(10'000), ::testing::HasSubstr("a leaf of"));  // read to its end
  EXPECT_THAT(message(400), ::testing::HasSubstr("too many for memory"));
  EXPECT_THAT(message(50), ::testing::HasSubstr("is too large"));
}

TEST_F(OctreeReader, OnlyFilesAreRead) {
  EXPECT_THAT(testing::error_text(Fault::kData, [] { read_octree("/dev/zero"); }),
              ::testing::HasSubstr("cannot be read"));
  const fs::path pipe = folder() / "pipe.ot";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THAT(testing::error_text(Fault::kData, [&] { read_octree(pipe); }),
              ::testing::HasSubstr("cannot be read"));
}

TEST_F(OctreeReader, OccupancyAlone) {
  const SavedOctree saved = read_octree(folder() / "map.bt");
  EXPECT_FALSE(saved.has_colors);
  EXPECT_TRUE(saved.classes.names.empty());
  octomap::OcTree reference((folder() / "map.bt").string());
  ASSERT_EQ(saved.tree->size(), reference.size());
  for (auto leaf = reference.begin_leafs(); leaf != reference.end_leafs(); ++leaf) {
    const SemanticVoxel* voxel = saved.tree->search(leaf.getKey());
    ASSERT_TRUE(voxel);
    ASSERT_EQ(saved.tree->isNodeOccupied(voxel), reference.isNodeOccupied(*leaf));
  }
}

TEST_F(OctreeReader, TreesOfOtherPrograms) {
  octomap::ColorOcTree colored(0.1);
  colored.updateNode(octomap::point3d(1, 2, 3), true);
  colored.setNodeColor(1, 2, 3, 10, 20, 30);
  colored.updateInnerOccupancy();
  octomap::OcTree plain(0.1);
  plain.updateNode(octomap::point3d(1, 2, 3), true);
  plain.updateNode(octomap::point3d(1, 2, -3), false);
  colored.write((folder() / "colored.ot").string());
  plain.write((folder() / "plain.ot").string());

  const SavedOctree first = read_octree(folder() / "colored.ot");
  ASSERT_TRUE(first.tree->search(1.0, 2.0, 3.0));
  EXPECT_EQ(first.tree->search(1.0, 2.0, 3.0)->getColor().g, 20);
  EXPECT_TRUE(first.classes.names.empty());
  const SavedOctree second = read_octree(folder() / "plain.ot");
  EXPECT_FALSE(second.has_colors);
  ASSERT_TRUE(second.tree->search(1.0, 2.0, -3.0));
  EXPECT_FALSE(second.tree->isNodeOccupied(second.tree->search(1.0, 2.0, -3.0)));
}

// Wherever a file ends too early, and whichever byte is wrong: a message or a map, nothing else.
TEST_F(OctreeReader, TruncatedFilesAreRefused) {
  for (const char* name : {"map.ot", "map.bt"}) {
    const std::string whole = contents(folder() / name);
    for (std::size_t size = 0; size < whole.size(); size += 1 + whole.size() / 97)
      EXPECT_THAT(message_for(written(whole.substr(0, size))),
                  ::testing::ContainsRegex("ends within|no octree"))
          << name << " of " << size;
  }
}

TEST_F(OctreeReader, DamagedFilesDoNoHarm) {
  std::uint32_t random = 1;
  for (const char* name : {"map.ot", "map.bt"}) {
    const std::string whole = contents(folder() / name);
    for (int i = 0; i < 60; ++i) {
      std::string damaged = whole;
      for (int k = 0; k < 20; ++k) {
        random = random * 1664525U + 1013904223U;
        damaged[100 + random % (damaged.size() - 100)] = static_cast<char>(random >> 24U);
      }
      try {
        const SavedOctree saved = read_octree(written(damaged));
        const auto floor = floor_of(*saved.tree, {});
        if (floor) project(*saved.tree, *floor, {});
      } catch (const Error& error) {
        EXPECT_EQ(error.fault(), Fault::kData);
      }
    }
  }
}

TEST_F(OctreeReader, WhatIsNoMapIsNamed) {
  EXPECT_THAT(message_for(folder() / "none.ot"), ::testing::HasSubstr("none.ot: cannot be read"));
  EXPECT_THAT(message_for(folder()), ::testing::HasSubstr("cannot be read"));
  EXPECT_THAT(message_for(folder() / "map.ply"), ::testing::HasSubstr("is no octree of OctoMap"));
  EXPECT_THAT(
      message_for(written("# Octomap OcTree file\nid CountingOcTree\nsize 1\nres 0.1\ndata\n")),
      ::testing::HasSubstr("type 'CountingOcTree'"));
  EXPECT_THAT(message_for(written("# Octomap OcTree file\nid OcTree\nsize 1\nres x\ndata\n")),
              ::testing::HasSubstr("no resolution"));
  EXPECT_THAT(message_for(written(contents(folder() / "map.ot") + "x")),
              ::testing::HasSubstr("more follows the map"));
}

}  // namespace
}  // namespace stillpoint::semantic_octree
