#include "stillpoint/support/atomic_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "stillpoint/error.hpp"
#include "support/full_disk.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;

class AtomicFileTest : public ::testing::Test {
 protected:
  static std::string contents(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  std::size_t files() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
  static void write(const fs::path& file, const std::string& text) {
    AtomicFile out(file);
    out.stream() << text;
    out.commit();
  }

  const testing::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.path();
};

TEST_F(AtomicFileTest, IsThereOnceItIsCommitted) {
  const fs::path file = folder_ / "new" / "folders" / "map";
  {
    AtomicFile out(file);
    out.stream() << "text";
    EXPECT_FALSE(fs::exists(file));
    out.commit();
  }
  EXPECT_EQ(contents(file), "text");
}

TEST_F(AtomicFileTest, WithoutCommitNothingIsLeft) {
  write(folder_ / "map", "old");
  {
    AtomicFile out(folder_ / "map");
    out.stream() << "new";
  }
  EXPECT_EQ(contents(folder_ / "map"), "old");
  EXPECT_EQ(files(), 1U);
}

TEST_F(AtomicFileTest, OnAFullDiskTheEarlierFileStaysWhole) {
  write(folder_ / "map", "old");
  {
    const testing::FullDisk full(65536);
    AtomicFile out(folder_ / "map");
    out.stream() << std::string(1 << 20, 'x');
    try {
      out.commit();
      FAIL() << "a file that is not whole was put in its place";
    } catch (const Error& error) {
      EXPECT_EQ(error.fault(), Fault::kUsage);
      EXPECT_THAT(error.what(), ::testing::HasSubstr("/map: cannot write: "));
      EXPECT_THAT(error.what(), ::testing::HasSubstr("free space"));
    }
  }
  EXPECT_EQ(contents(folder_ / "map"), "old");
  EXPECT_EQ(files(), 1U);
}

TEST_F(AtomicFileTest, OfTwoThatAreWrittenAtOnceBothAreWhole) {
  AtomicFile first(folder_ / "map"), second(folder_ / "map");
  first.stream() << "the longer one";
  second.stream() << "short";
  second.commit();
  EXPECT_EQ(contents(folder_ / "map"), "short");
  first.commit();
  EXPECT_EQ(contents(folder_ / "map"), "the longer one");
  EXPECT_EQ(files(), 1U);
}

TEST_F(AtomicFileTest, FilesBesideItAreSomebodyElses) {
  std::ofstream(folder_ / "map.part") << "mine";
  write(folder_ / "map", "text");
  EXPECT_EQ(contents(folder_ / "map.part"), "mine");
}

TEST_F(AtomicFileTest, WhatIsNoFileStays) {
  const fs::path pipe = folder_ / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THROW(AtomicFile{pipe}, Error);
  EXPECT_TRUE(fs::is_fifo(pipe));
  EXPECT_EQ(files(), 1U);
}

TEST_F(AtomicFileTest, InTheWorkingFolder) {
  const fs::path before = fs::current_path();
  fs::current_path(folder_);
  write("map", "text");
  fs::current_path(before);
  EXPECT_EQ(contents(folder_ / "map"), "text");
}

TEST_F(AtomicFileTest, WhereNoFileCanBeIsAnError) {
  write(folder_ / "map", "a file");
  EXPECT_THROW(AtomicFile(folder_ / "map" / "file"), Error);
  EXPECT_THROW(AtomicFile("/proc/no_such_folder/file"), Error);
  fs::create_directories(folder_ / "folder" / "inside");
  EXPECT_THROW(write(folder_ / "folder", "text"), Error);
}

}  // namespace
}  // namespace stillpoint
