#include "tum_recording/recording.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/error_text.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint::tum_recording {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using testing::error_text;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::TemporaryFolder;

/// The message for a recording with these lists.
std::string message_for(const std::string& rgb, const std::string& depth) {
  const TemporaryFolder folder;
  folder.write("rgb.txt", rgb);
  folder.write("depth.txt", depth);
  return error_text(Fault::kData, [&] { open_recording(folder.path()); });
}

TEST(Recording, PairsTheListsByTime) {
  const TemporaryFolder folder;
  folder.write("rgb.txt", "# comment\n1.00 rgb/a.png\n1.03 rgb/b.png\n9.0 rgb/c.png\n");
  folder.write("depth.txt", "1.01,depth/a.png\r\n\r\n1.04\tdepth/b.png\r\n");
  folder.write("groundtruth.txt", "");
  const Recording recording = open_recording(folder.path());
  ASSERT_EQ(recording.pairs.size(), 2u);
  EXPECT_EQ(recording.pairs[1].color.time, 1.03);
  EXPECT_EQ(recording.pairs[1].color.file, folder.path() / "rgb/b.png");
  EXPECT_EQ(recording.pairs[1].depth.file, folder.path() / "depth/b.png");
  EXPECT_EQ(recording.color.size(), 3u);
  EXPECT_EQ(recording.ground_truth, folder.path() / "groundtruth.txt");
  EXPECT_THAT(recording.warnings, IsEmpty());
}

TEST(Recording, AddsTheTimeOffsetToDepth) {
  const TemporaryFolder folder;
  folder.write("rgb.txt", "1.0 a\n2.0 b\n");
  folder.write("depth.txt", "1.5 d\n2.5 e\n");
  EXPECT_EQ(open_recording(folder.path(), {.time_offset = -0.5}).pairs.size(), 2u);
  EXPECT_THAT(error_text(Fault::kData, [&] { open_recording(folder.path()); }),
              AllOf(HasSubstr("no colour image has a depth image within"),
                    HasSubstr("colour images: 1.000 to 2.000, depth images: 1.500 to 2.500"),
                    HasSubstr("times are seconds on one clock")));
}

TEST(Recording, TimesInAnotherUnitAreWarnedOf) {
  const TemporaryFolder folder;
  folder.write("rgb.txt", "1000.0 a\n1033.3 b\n1066.7 c\n");
  folder.write("depth.txt", "1000.0 d\n1033.3 e\n1066.7 f\n");
  EXPECT_THAT(open_recording(folder.path()).warnings,
              ElementsAre(HasSubstr("images are 33.400 s apart; times are seconds")));
}

TEST(Recording, ReadsAssociationsInEitherOrder) {
  for (const char* name : {"associations.txt", "associate.txt", "associations"}) {
    for (const char* line :
         {"1.0 rgb/a.png 1.5 depth/b.png\n", "1.5 depth/b.png 1.0 rgb/a.png\n"}) {
      const TemporaryFolder folder;
      folder.write(name, line);
      const Recording recording = open_recording(folder.path());
      ASSERT_EQ(recording.pairs.size(), 1u) << name;
      EXPECT_EQ(recording.pairs[0].color.time, 1.0);
      EXPECT_EQ(recording.pairs[0].color.file, folder.path() / "rgb/a.png");
      EXPECT_EQ(recording.pairs[0].depth.time, 1.5);
      EXPECT_EQ(recording.pairs[0].depth.file, folder.path() / "depth/b.png");
    }
  }
}

TEST(Recording, PrefersListsUnlessToldOtherwise) {
  const TemporaryFolder folder;
  folder.write("rgb.txt", "1.0 rgb/a\n2.0 rgb/b\n");
  folder.write("depth.txt", "1.0 depth/a\n2.0 depth/b\n");
  folder.write("associations.txt", "1.0 rgb/a 1.0 depth/a\n");
  EXPECT_EQ(open_recording(folder.path()).pairs.size(), 2u);
  const Recording associated = open_recording(folder.path(), {.prefer = PairsFrom::kAssociations});
  EXPECT_EQ(associated.pairs.size(), 1u);
  EXPECT_EQ(associated.pairs_from, folder.path() / "associations.txt");
}

TEST(Recording, SortsAndDropsRepeatedStampsWithAWarning) {
  const TemporaryFolder folder;
  folder.write("rgb.txt", "2.0 second\n1.0 first\n2.0 again\n");
  folder.write("depth.txt", "1.0 depth\n");
  const Recording recording = open_recording(folder.path());
  ASSERT_EQ(recording.color.size(), 2u);
  EXPECT_EQ(recording.color[0].file.filename(), "first");
  EXPECT_EQ(recording.color[1].file.filename(), "second");
  EXPECT_THAT(recording.warnings,
              ElementsAre(HasSubstr("rgb.txt: time stamps are not in order"),
                          HasSubstr("rgb.txt: 1 repeated time stamps; the first")));
}

TEST(Recording, DropsImagesThatAssociationsUseTwice) {
  const TemporaryFolder folder;
  folder.write("associations.txt",
               "2.0 rgb/b 2.0 depth/b\n1.0 rgb/a 1.0 depth/a\n2.0 rgb/b 2.1 depth/c\n");
  const Recording recording = open_recording(folder.path());
  EXPECT_EQ(recording.pairs.size(), 2u);
  EXPECT_EQ(recording.warnings.size(), 2u);
}

TEST(Recording, NamesWhatIsMissing) {
  const TemporaryFolder folder;
  EXPECT_THAT(error_text(Fault::kData, [&] { open_recording(folder.path() / "nowhere"); }),
              AllOf(HasSubstr("nowhere: no such folder"), HasSubstr("rgb.txt and depth.txt")));
  EXPECT_THAT(error_text(Fault::kData, [&] { open_recording(folder.write("file", "")); }),
              HasSubstr("file: is not a folder"));
  EXPECT_THAT(error_text(Fault::kData, [&] { open_recording(folder.path()); }),
              HasSubstr("has neither rgb.txt and depth.txt nor associations.txt"));
  folder.write("rgb.txt", "1.0 a\n");
  EXPECT_THAT(error_text(Fault::kData, [&] { open_recording(folder.path()); }),
              HasSubstr("has rgb.txt but no depth.txt"));
}

TEST(Recording, NamesTheLineThatCannotBeUnderstood) {
  EXPECT_THAT(message_for("# only a comment\n", "1.0 d\n"), HasSubstr("rgb.txt: lists no images"));
  EXPECT_THAT(message_for("1.0 a\n", ""), HasSubstr("depth.txt: lists no images"));
  EXPECT_THAT(
      message_for("# c\n1.0\n", "1.0 d\n"),
      HasSubstr("rgb.txt:2: found one column, '1.0'; expected a time stamp and a file name"));
  EXPECT_THAT(message_for("1.0 a\n", "1.0 d\nx.5 e\n"),
              HasSubstr("depth.txt:2: 'x.5' is not a time stamp"));
  EXPECT_THAT(message_for("nan a\n", "1.0 d\n"), HasSubstr("rgb.txt:1: 'nan' is not a time stamp"));
  const TemporaryFolder folder;
  folder.write("associations.txt", "1.0 rgb/a 1.0\n");
  EXPECT_THAT(error_text(Fault::kData, [&] { open_recording(folder.path()); }),
              HasSubstr("associations.txt:1: found 3 columns"));
}

}  // namespace
}  // namespace stillpoint::tum_recording
