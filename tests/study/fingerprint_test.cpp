#include "study/fingerprint.hpp"

#include <gtest/gtest.h>

#include "stillpoint/error.hpp"
#include "study/pipeline_fingerprint.hpp"
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

TEST(Fingerprint, OfAPipelineSeesNetworksAndLabels) {
  const TemporaryFolder folder, models;
  const std::string network = folder.write("nets/own.onnx", "network");
  folder.write("labels/1.png", "image");
  folder.write("recording/1.png", "image");
  PipelineFingerprints fingerprints({models.path()});
  const auto print = [&](const std::string& schedule = "wait") {
    const std::string root = folder.path();
    return fingerprints.of("source: {path: " + root + "/recording}\nsegmenter:\n  model: " +
                               network + "\n  path: " + root + "/labels\nother: [{model: " + root +
                               "/found.onnx}, " + schedule + "]\n",
                           folder.path() / "recording");
  };
  const std::string before = print();
  EXPECT_EQ(print(), before);
  EXPECT_NE(print("latest"), before);
  folder.write("recording/1.png", "another image");
  EXPECT_EQ(print(), before) << "the recording has a fingerprint of its own";
  folder.write("nets/own.onnx", "another network");
  const std::string retrained = print();
  EXPECT_NE(retrained, before);
  folder.write("labels/2.png", "");
  const std::string relabelled = print();
  EXPECT_NE(relabelled, retrained);
  models.write("found.onnx", "network");
  EXPECT_NE(print(), relabelled);
}

TEST(Fingerprint, OfAPipelineIsTheSameInAnotherInstallation) {
  const TemporaryFolder here, there;
  const auto print = [&](const std::string& root, const std::string& comment) {
    PipelineFingerprints fingerprints({root + "/models"});
    return fingerprints.of("segmenter:  # " + comment + "\n  model: " + root +
                               "/configs/own.onnx\n  path: " + root +
                               "/labels\nsource: {path: " + root + "/recording}\n",
                           root + "/recording");
  };
  for (const TemporaryFolder* folder : {&here, &there}) {
    folder->write("models/own.onnx", "network");
    folder->write("labels/1.png", "image");
  }
  const std::string first = print(here.path(), "as built");
  EXPECT_EQ(print(there.path(), "as installed"), first);
  there.write("models/own.onnx", "NETWORK");
  EXPECT_NE(print(there.path(), "as installed"), first);
}

// Results of earlier versions count as long as this holds.
TEST(Fingerprint, OfAPipelineIsThatOfItsKeysAndValues) {
  const std::string expected = Fingerprint()
                                   .add("version")
                                   .add("1")
                                   .add("source")
                                   .add("path")
                                   .add("type")
                                   .add("tum")
                                   .add("")
                                   .add("outputs")
                                   .add("type")
                                   .add("images")
                                   .add("")
                                   .add("")
                                   .add("")
                                   .text();
  PipelineFingerprints fingerprints({});
  for (int i = 0; i < 2; ++i)  // the second time known
    EXPECT_EQ(fingerprints.of("# all\nversion: 1\nsource:  # of images\n  path: /recording\n"
                              "  type: tum\noutputs:\n  - type: images\n",
                              "/recording"),
              expected);
}

TEST(Fingerprint, OfAProgramIsThatOfItsFiles) {
  const TemporaryFolder here, there;
  FileContents contents;
  const auto print = [&](const TemporaryFolder& folder) {
    return program_fingerprint({folder.path() / "bin/program", folder.path() / "lib/plugin.so"},
                               contents);
  };
  for (const TemporaryFolder* folder : {&here, &there}) {
    folder->write("bin/program", "code");
    folder->write("lib/plugin.so", "more code");
  }
  EXPECT_EQ(print(here), print(there));
  there.write("lib/plugin.so", "MORE CODE!");
  EXPECT_NE(print(here), print(there));
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
