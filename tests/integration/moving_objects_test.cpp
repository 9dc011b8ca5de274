// The pipelines for scenes with people, from the recording to the trajectory.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "support/absolute_error.hpp"
#include "support/simulated_recording.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr double kAccuracy = 0.006;  // metres

// Labels of the simulator with the errors of a network.
const std::vector<std::string> kImitatedNetwork = {"--set", "segmenter.type=label_images",
                                                   "--set", "segmenter.miss_rate=0.1",
                                                   "--set", "segmenter.outline_error=2"};

class MovingObjects : public ::testing::Test {
 protected:
  Outcome run(const std::string& name, const std::string& pipeline, const std::string& mode,
              const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {"run",       pipeline,
                                          "--dataset", recording_with_people().string(),
                                          "-o",        (out() / name).string(),
                                          "--set",     "runtime.mode=" + mode};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return call(std::move(arguments));
  }

  void expect_accurate(const std::string& name) const {
    EXPECT_EQ(json_file(out() / name / "summary.json")["coverage"], 1.0) << name;
    EXPECT_LT(absolute_error(recording_with_people(), out() / name / "trajectory.txt"), kAccuracy)
        << name;
  }

  const fs::path& out() const { return folder_.path(); }
  TemporaryFolder folder_;
};

class Method : public MovingObjects, public ::testing::WithParamInterface<const char*> {};
INSTANTIATE_TEST_SUITE_P(Pipelines, Method,
                         ::testing::Values("semantic_only", "ds_slam", "stillpoint",
                                           "geometry_only"),
                         [](const auto& test) { return std::string(test.param); });

TEST_P(Method, IsAccurateInBothModes) {
  const std::string pipeline = GetParam();
  for (const std::string mode : {"inline", "threaded"}) {
    if (sanitized_build() && mode == "inline") continue;  // the same code with less to go wrong
    const auto more = pipeline == "geometry_only" ? std::vector<std::string>() : kImitatedNetwork;
    const Outcome outcome = run(mode, pipeline, mode, more);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    expect_accurate(mode);
  }
}

TEST_F(MovingObjects, InlineRepeatsEveryByteWithTheShippedNetwork) {
  if (sanitized_build()) GTEST_SKIP() << "a network takes minutes under a sanitizer";
  for (const char* name : {"first", "second"}) {
    const Outcome outcome = run(name, "stillpoint", "inline", {});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }
  EXPECT_EQ(text_of(out() / "first/trajectory.txt"), text_of(out() / "second/trajectory.txt"));
  expect_accurate("first");
}

TEST_F(MovingObjects, AModelThatIsNotThereIsNamedAtTheStart) {
  const Outcome outcome =
      run("missing", "ds_slam", "threaded", {"--set", "segmenter.model=nothing.onnx"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("nothing.onnx"));
}

TEST_F(MovingObjects, AClassThatNobodyKnowsIsExplainedAtTheStart) {
  const Outcome outcome = run("class", "ds_slam", "threaded", {"--set", "decision.labels=[persn]"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("did you mean 'person'?"));
}

// Labels that become unreadable on the way: the run ends with what it has, or goes on.
TEST_F(MovingObjects, OnFailureDecidesWhatAFailingSegmenterDoes) {
  TemporaryFolder labels;
  fs::copy(recording_with_people() / "labels", labels.path() / "labels");
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(labels.path() / "labels"))
    files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::ofstream(files.at(10)) << "no image";
  const std::vector<std::string> from = {"--set", "segmenter.type=label_images", "--set",
                                         "segmenter.path=" + (labels.path() / "labels").string()};

  const Outcome stopped = run("stopped", "semantic_only", "inline", from);
  EXPECT_NE(stopped.exit_code, 0);
  EXPECT_THAT(stopped.err, HasSubstr(files[10].filename().string()));
  EXPECT_EQ(count_poses(out() / "stopped/trajectory.txt"), 10u);

  auto on = from;
  on.insert(on.end(), {"--set", "segmenter.on_failure=continue"});
  const Outcome went_on = run("on", "semantic_only", "inline", on);
  EXPECT_EQ(went_on.exit_code, 0) << went_on.err;
  const auto summary = json_file(out() / "on/summary.json");
  EXPECT_EQ(summary["unlabelled_frames"], 1);
  EXPECT_EQ(summary["segmentation_failures"], 1);
  EXPECT_THAT(summary["segmentation_failure"].get<std::string>(),
              HasSubstr(files[10].filename().string()));
}

}  // namespace
}  // namespace stillpoint::testing
