#include "stillpoint/engine/folder_lock.hpp"

#include <gtest/gtest.h>

#include "stillpoint/error.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint {
namespace {

TEST(FolderLock, HoldsOneAndLeavesNothing) {
  const testing::TemporaryFolder folder;
  {
    const FolderLock lock(folder.path());
    EXPECT_THROW(FolderLock(folder.path()), Error);
  }
  EXPECT_NO_THROW(FolderLock(folder.path()));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(FolderLock, NeedsAFolder) { EXPECT_THROW(FolderLock("/nowhere"), Error); }

}  // namespace
}  // namespace stillpoint
