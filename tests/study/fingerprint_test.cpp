#include "study/fingerprint.hpp"

#include <gtest/gtest.h>

#include "stillpoint/error.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint::study {
namespace {

using testing::TemporaryFolder;

TEST(Fingerprint, IsFnv1aOfThePartsAndTheirEnds) {
  EXPECT_EQ(Fingerprint().text(), "cbf29ce484222325");
  EXPECT_EQ(Fingerprint().add("ab").text(), Fingerprint().add("ab").text());
  EXPECT_NE(Fingerprint().add("ab").add("c").text(), Fingerprint().add("a").add("bc").text());
  EXPECT_NE(Fingerprint().add("").text(), Fingerprint().text());
}

TEST(Fingerprint, OfACellDependsOnPipelineRecordingAndSeed) {
  const std::string one = cell_fingerprint("pipeline", "recording", 1);
  EXPECT_EQ(one, cell_fingerprint("pipeline", "recording", 1));
  EXPECT_NE(one, cell_fingerprint("pipeline2", "recording", 1));
  EXPECT_NE(one, cell_fingerprint("pipeline", "recording2", 1));
  EXPECT_NE(one, cell_fingerprint("pipeline", "recording", 2));
}

TEST(Fingerprint, OfARecordingSeesListsAndImages) {
  const TemporaryFolder folder;
  folder.write("groundtruth.txt", "1 0 0 0 0 0 0 1\n");
  folder.write("rgb/1.png", "image");
  const std::string before = recording_fingerprint(folder.path());
  EXPECT_EQ(recording_fingerprint(folder.path()), before);
  folder.write("groundtruth.txt", "1 0 0 9 0 0 0 1\n");  // as long as before
  const std::string moved = recording_fingerprint(folder.path());
  EXPECT_NE(moved, before);
  folder.write("rgb/1.png", "another image");
  const std::string repainted = recording_fingerprint(folder.path());
  EXPECT_NE(repainted, moved);
  folder.write("rgb/2.png", "");
  EXPECT_NE(recording_fingerprint(folder.path()), repainted);
}

TEST(Fingerprint, OfNoRecordingIsAFaultOfTheData) {
  try {
    recording_fingerprint("/no/such/recording");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kData);
  }
}

}  // namespace
}  // namespace stillpoint::study
