#include "stillpoint/runtime/folder_contents.hpp"

#include <gmock/gmock.h>

#include <chrono>
#include <filesystem>

#include "support/recording_writer.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(FolderContents, KnowsWhatHasBeenWritten) {
  const testing::TemporaryFolder folder;
  folder.write("same", "1");
  folder.write("longer", "1");
  folder.write("later", "1");
  const FolderContents before(folder.path());
  EXPECT_THAT(before.written_since(), IsEmpty());

  folder.write("longer", "12");
  fs::last_write_time(folder.path() / "later",
                      fs::file_time_type::clock::now() + std::chrono::hours(1));
  folder.write("below/new", "1");
  fs::create_symlink("/etc", folder.path() / "link");
  EXPECT_THAT(before.written_since(), ElementsAre("below/new", "later", "longer"));
}

TEST(FolderContents, AFolderThatIsNotThereIsEmpty) {
  const testing::TemporaryFolder folder;
  const FolderContents before(folder.path() / "later");
  EXPECT_THAT(before.written_since(), IsEmpty());
  folder.write("later/file", "1");
  EXPECT_THAT(before.written_since(), ElementsAre("file"));
}

}  // namespace
}  // namespace stillpoint
