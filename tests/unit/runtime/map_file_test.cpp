#include "stillpoint/engine/map_file.hpp"

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>

#include "map_file_fixture.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

TEST_F(MapFile, FeaturesOfOtherTrackersMayHaveNoDescriptors) {
  MapEdit map{SparseMap()};
  KeyFrame keyframe{.id = 0};
  keyframe.camera = std::make_shared<const Camera>();
  keyframe.features =
      std::make_shared<const Features>(Features{.keypoints = {{10, 20, 1}}, .depth = {1.5F}});
  keyframe.track_weights = keyframe.map_weights = {255};
  keyframe.landmarks = {kNoId};
  map.add_keyframe(std::move(keyframe));
  save_map(map.map(), file_);
  const SparseMap loaded = load_map(file_);
  expect_same(map.map(), loaded);
  EXPECT_EQ(loaded.keyframe(0)->features->size(), 1u);
}

TEST_F(MapFile, GivesBackWhatWasSaved) {
  const SparseMap map = small_map();
  save_map(map, file_);
  const SparseMap loaded = load_map(file_);
  EXPECT_EQ(loaded.check(), std::nullopt);
  expect_same(map, loaded);
  EXPECT_EQ(loaded.keyframe_id_end(), loaded.keyframe_count()) << "ids without gaps";
  EXPECT_EQ(loaded.keyframe(0)->camera, loaded.keyframe(1)->camera) << "one camera, kept once";
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 1) << "nothing else is left";
}

TEST_F(MapFile, SavingTwiceGivesTheSameBytes) {
  save_map(small_map(), file_);
  const std::string first = read_bytes(file_);
  save_map(load_map(file_), file_);
  EXPECT_EQ(read_bytes(file_), first);
}

TEST_F(MapFile, AnEmptyMapIsAMap) {
  save_map(SparseMap{}, file_);
  EXPECT_TRUE(load_map(file_).empty());
}

TEST_F(MapFile, MissingForeignAndNewerFilesAreRefused) {
  EXPECT_THROW(load_map(file_), Error);
  write_bytes("this is a diary");
  expect_refused("not a database");
  write_bytes("");
  expect_refused("no map of Stillpoint");
  fs::remove(file_);
  execute("CREATE TABLE birds (name TEXT)");
  expect_refused("no map of Stillpoint");
  save_map(small_map(), file_);
  execute("PRAGMA user_version = 7");
  expect_refused("its version is 7");
}

TEST_F(MapFile, TruncatedFilesAreRefused) {
  save_map(small_map(), file_);
  const std::string whole = read_bytes(file_);
  for (const double share : {0.01, 0.1, 0.5, 0.9, 0.999}) {
    write_bytes(
        whole.substr(0, static_cast<std::size_t>(share * static_cast<double>(whole.size()))));
    EXPECT_THROW(load_map(file_), Error) << share;
  }
}

// Either refused with a message or, where it hit unused bytes, read as it was.
TEST_F(MapFile, DamagedBytesNeverCrash) {
  const SparseMap map = small_map();
  save_map(map, file_);
  const std::string whole = read_bytes(file_);
  std::mt19937_64 random(1);
  int refused = 0;
  for (int i = 0; i < 200; ++i) {
    std::string damaged = whole;
    damaged[random() % whole.size()] ^= static_cast<char>(1 + random() % 255);
    write_bytes(damaged);
    try {
      expect_same(map, load_map(file_));
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 50);
}

TEST_F(MapFile, WhatCannotBeWrittenIsSaid) {
  try {
    save_map(small_map(3), "/proc/nowhere/map");
    FAIL() << "written";
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kUsage);
    EXPECT_THAT(error.what(), HasSubstr("/proc/nowhere: cannot write: "));
  }
}

TEST_F(MapFile, WithoutRoomTheEarlierFileStays) {
  save_map(small_map(), file_);
  const std::string before = read_bytes(file_);
  rlimit unlimited{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &unlimited), 0);
  const rlimit small{.rlim_cur = 4096, .rlim_max = unlimited.rlim_max};  // bytes
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ::setrlimit(RLIMIT_FSIZE, &small);
  EXPECT_THROW(save_map(small_map(30), file_), Error);
  ::setrlimit(RLIMIT_FSIZE, &unlimited);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(read_bytes(file_), before);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 1) << "nothing else is left";
}

TEST_F(MapFile, WhatIsNoFileStays) {
  ASSERT_EQ(::mkfifo(file_.c_str(), 0600), 0);
  EXPECT_THROW(save_map(small_map(), file_), Error);
  EXPECT_TRUE(fs::is_fifo(file_));
  EXPECT_THROW(save_map(small_map(), folder_.path()), Error);
}

TEST_F(MapFile, FilesBesideItStay) {
  const fs::path mine = file_.string() + ".part";
  std::ofstream(mine) << "mine";
  save_map(small_map(), file_);
  EXPECT_EQ(read_bytes(mine), "mine");
}

// The kernel ends the process where the new file would grow beyond a limit, at forty places of it.
TEST_F(MapFile, ADyingProcessLeavesTheEarlierFile) {
  constexpr int kPlaces = 40;
  const SparseMap earlier = small_map(3), later = small_map(30);
  save_map(later, file_);
  const auto size = fs::file_size(file_);
  save_map(earlier, file_);
  for (int i = 0; i < kPlaces; ++i) {
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      const rlimit no_core{0, 0}, bytes{size * i / kPlaces, size * i / kPlaces};
      ::setrlimit(RLIMIT_CORE, &no_core);
      ::setrlimit(RLIMIT_FSIZE, &bytes);
      save_map(later, file_);
      ::_exit(0);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGXFSZ) << i;
    ASSERT_EQ(load_map(file_).keyframe_count(), earlier.keyframe_count()) << i;
  }
  save_map(later, file_);  // what the dead have left is in nobody's way
  EXPECT_EQ(load_map(file_).keyframe_count(), later.keyframe_count());
}

}  // namespace
}  // namespace stillpoint
