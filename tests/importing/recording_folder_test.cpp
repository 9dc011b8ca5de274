#include "importing/recording_folder.hpp"

#include <stop_token>
#include <vector>

#include "importing/fixtures.hpp"
#include "support/full_disk.hpp"

namespace stillpoint::importing {
namespace {

using ::testing::HasSubstr;

/// Frames of images in memory; asks for a stop at one of them.
class InMemory final : public ForeignRecording {
 public:
  explicit InMemory(std::size_t bytes) : bytes_(bytes) {}
  std::size_t size() const override { return 5; }
  ForeignFrame read(std::size_t index) override {
    if (index == stop_at) stop.request_stop();
    return {StoredImage{.time = 0.1 * static_cast<double>(index), .bytes = bytes_},
            StoredImage{.time = 0.1 * static_cast<double>(index), .bytes = bytes_}};
  }
  std::stop_source stop;
  std::size_t stop_at = 99;

 private:
  std::vector<std::uint8_t> bytes_;
};

class RecordingFolderTest : public ::testing::Test {
 protected:
  fs::path out() const { return folder_.path() / "out"; }
  TemporaryFolder folder_;
};

TEST_F(RecordingFolderTest, StoppedLeavesNothing) {
  InMemory recording(10);
  recording.stop_at = 2;
  {
    RecordingFolder folder(out());
    EXPECT_FALSE(add_frames(recording, folder, recording.stop.get_token(), [](std::size_t) {}));
    EXPECT_EQ(folder.written(), 6u);
    EXPECT_FALSE(fs::exists(out()));
  }
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

TEST_F(RecordingFolderTest, FullDiskIsOneMessageAndLeavesNothing) {
  const auto import = [this] {
    InMemory recording(10'000);
    RecordingFolder folder(out());
    const testing::FullDisk full(4096);
    add_frames(recording, folder, {}, [](std::size_t) {});
  };
  EXPECT_THAT(refusal(import), HasSubstr("rgb/0.000000.png: cannot be written: File too large; "
                                         "check the folder's permissions and the free space"));
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

TEST_F(RecordingFolderTest, FullDiskAtTheListsLeavesNothing) {
  const auto import = [this] {
    InMemory recording(10);
    RecordingFolder folder(out());
    add_frames(recording, folder, {}, [](std::size_t) {});
    const testing::FullDisk full(100);
    folder.commit({}, "version: 1\n");
  };
  EXPECT_THAT(refusal(import), HasSubstr("rgb.txt: cannot be written: File too large"));
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

TEST_F(RecordingFolderTest, WhatIsThereIsNotTouched) {
  fs::create_directories(out());
  EXPECT_THAT(refusal([this] { RecordingFolder{out() / ""}; }),
              HasSubstr("out: is there already; name another folder or remove this one"));
  EXPECT_TRUE(fs::exists(out()));
  fs::remove(out());
  folder_.write("out.partial/rgb/1.png", "x");
  EXPECT_THAT(refusal([this] { RecordingFolder{out()}; }),
              HasSubstr("out.partial: is left of an import that did not end"));
  EXPECT_TRUE(fs::exists(folder_.path() / "out.partial/rgb/1.png"));
}

TEST_F(RecordingFolderTest, NoFolderCanBeMadeThere) {
  folder_.write("file", "x");
  EXPECT_THAT(refusal([this] { RecordingFolder{folder_.path() / "file/out"}; }),
              HasSubstr("cannot be written: "));
}

}  // namespace
}  // namespace stillpoint::importing
