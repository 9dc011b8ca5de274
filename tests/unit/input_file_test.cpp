#include "stillpoint/support/input_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "support/error_text.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(InputFile, IsReadAsItIs) {
  const testing::TemporaryFolder folder;
  const std::string bytes("a\0b\r\n", 5);
  folder.write("file", bytes);
  EXPECT_EQ(read_input_file(folder.path() / "file"), bytes);
  EXPECT_EQ(input_file_size(folder.path() / "file", 5), 5U);
  folder.write("file", "");
  EXPECT_EQ(read_input_file(folder.path() / "file"), "");
}

TEST(InputFile, WhatIsNoFileOrTooLargeIsRefusedUnread) {
  const testing::TemporaryFolder folder;
  const fs::path file = folder.path() / "file";
  const auto refusal = [&] {
    return testing::error_text(Fault::kData, [&] { read_input_file(file); });
  };
  EXPECT_THAT(refusal(), AllOf(HasSubstr(file.string()), HasSubstr("no such file")));
  ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
  EXPECT_THAT(refusal(), HasSubstr("is no regular file"));
  fs::remove(file);
  fs::create_symlink("/dev/zero", file);
  EXPECT_THAT(refusal(), HasSubstr("is no regular file"));
  fs::remove(file);
  fs::create_directory(file);
  EXPECT_THAT(refusal(), HasSubstr("is no regular file"));
  fs::remove(file);
  folder.write("file", "");
  fs::resize_file(file, 20'000'000'000);  // sparse
  EXPECT_THAT(refusal(), HasSubstr("has 19073 MiB; such a file has at most 64"));
}

}  // namespace
}  // namespace stillpoint
