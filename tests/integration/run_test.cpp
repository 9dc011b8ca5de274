// stillpoint run on a recording that is whole: from the folder on disk to the trajectory.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "support/absolute_error.hpp"
#include "support/simulated_recording.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr double kWholeAccuracy = 0.006;  // metres; what is asked of the whole sequence

class Run : public ::testing::Test {
 protected:
  // With these arguments after the pipeline; the run folder is `out` and the name.
  Outcome run(const std::string& name, const std::string& pipeline,
              std::vector<std::string> arguments, const Surroundings& surroundings = {}) const {
    arguments.insert(arguments.begin(), {"run", pipeline, "-o", (out() / name).string()});
    return call(std::move(arguments), surroundings);
  }
  Outcome run_baseline(const std::string& name, const std::string& mode) const {
    return run(name, "orb_baseline",
               {"--dataset", simulated_recording().string(), "--set", "runtime.mode=" + mode});
  }
  const fs::path& out() const { return folder_.path(); }

  void expect_accurate(const std::string& name) const {
    const auto summary = json_file(out() / name / "summary.json");
    EXPECT_TRUE(summary["complete"]);
    EXPECT_EQ(summary["frames"], kSimulatedFrames);
    EXPECT_EQ(summary["coverage"], 1.0);
    EXPECT_EQ(summary["times_lost"], 0);
    EXPECT_EQ(summary["skipped_images"], 0);
    const fs::path trajectory = out() / name / "trajectory.txt";
    EXPECT_EQ(count_poses(trajectory), kSimulatedFrames);
    EXPECT_LT(absolute_error(simulated_recording(), trajectory), kWholeAccuracy);
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(Run, InlineIsAccurateAndRepeatsEveryByte) {
  for (const char* name : {"first", "second"}) {
    const Outcome outcome = run_baseline(name, "inline");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("tracked " + std::to_string(kSimulatedFrames)));
  }
  expect_accurate("first");
  for (const char* file : {"trajectory.txt", "keyframes.txt"}) {
    const std::string text = text_of(out() / "first" / file);
    EXPECT_FALSE(text.empty());
    EXPECT_TRUE(text == text_of(out() / "second" / file)) << file << " differs";
  }
}

TEST_F(Run, ThreadedIsAccurate) {
  const Outcome outcome = run_baseline("threaded", "threaded");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  expect_accurate("threaded");
  EXPECT_EQ(json_file(out() / "threaded/summary.json")["mode"], "threaded");
  for (const char* file : {"pipeline.yaml", "keyframes.txt", "timings.csv", "log.txt"})
    EXPECT_GT(fs::file_size(out() / "threaded" / file), 0u) << file;
}

// The sensor's pace may drop frames on a slow machine, but accounts for each of them.
TEST_F(Run, SensorPaceAccountsForEveryFrame) {
  const Outcome outcome =
      run("paced", "orb_baseline",
          {"--dataset", simulated_recording().string(), "--set", "runtime.pace=sensor"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto summary = json_file(out() / "paced/summary.json");
  EXPECT_EQ(summary["frames"], kSimulatedFrames);
  EXPECT_EQ(summary["processed_frames"].get<int>() + summary["dropped_frames"].get<int>(),
            kSimulatedFrames);
}

TEST_F(Run, SceneIsRenderedWithoutFiles) {
  TemporaryFolder folder;
  const fs::path scene = fs::path(STILLPOINT_SOURCE_DIR) / "configs/scenes" / kScene;
  const fs::path pipeline = folder.write("scene.yaml", "version: 1\nextends: " + scene.string() +
                                                           ".yaml\n"
                                                           "source: {frames: 20}\n"
                                                           "tracker: {type: orb}\n"
                                                           "local_mapper: {type: orb}\n"
                                                           "outputs: [{type: trajectory}]\n");
  const Outcome outcome = run("scene", pipeline.string(), {});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const fs::path trajectory = out() / "scene/trajectory.txt";
  EXPECT_EQ(count_poses(trajectory), 20u);
  EXPECT_LT(absolute_error(simulated_recording(), trajectory), kWholeAccuracy);
}

// A relative recording is relative to where the program is called; the camera lies beside it.
TEST_F(Run, IsTheSameFromEveryFolder) {
  const std::vector<std::string> limited = {"--set", "source.limit=5", "--set",
                                            "runtime.mode=inline", "--dataset"};
  auto relative = limited, absolute = limited;
  relative.push_back(simulated_recording().filename().string());
  absolute.push_back(simulated_recording().string());
  const Outcome beside =
      run("beside", "orb_baseline", relative, {.folder = simulated_recording().parent_path()});
  const fs::path file = fs::path(STILLPOINT_SOURCE_DIR) / "configs/pipelines/orb_baseline.yaml";
  const Outcome elsewhere = run("elsewhere", file.string(), absolute, {.folder = out()});
  ASSERT_EQ(beside.exit_code, 0) << beside.err;
  ASSERT_EQ(elsewhere.exit_code, 0) << elsewhere.err;
  EXPECT_EQ(count_poses(out() / "beside/trajectory.txt"), 5u);
  for (const char* name : {"trajectory.txt", "pipeline.yaml"})
    EXPECT_EQ(text_of(out() / "beside" / name), text_of(out() / "elsewhere" / name));
  EXPECT_THAT(text_of(out() / "beside/pipeline.yaml"), HasSubstr("name: simulated"));
}

TEST_F(Run, FolderIsNamedAfterThePipelineUnlessGiven) {
  const Outcome outcome = call({"run", "orb_baseline", "--dataset", simulated_recording().string(),
                                "--set", "source.limit=2"},
                               {.folder = out()});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(count_poses(out() / "out/orb_baseline/trajectory.txt"), 2u);
}

// The stored file says everything: it loads again, also without the recording's camera.yaml, and
// printing it changes nothing.
TEST_F(Run, StoredPipelineIsTheEffectiveOne) {
  const std::vector<std::string> settings = {
      "--dataset", simulated_recording().string(), "--set", "source.limit=3",
      "--set",     "tracker.features=800",         "--set", "runtime.mode=inline"};
  ASSERT_EQ(run("run", "orb_baseline", settings).exit_code, 0);
  const fs::path stored = out() / "run/pipeline.yaml";
  EXPECT_THAT(text_of(stored), HasSubstr("features: 800"));

  std::vector<std::string> check = {"check", "orb_baseline", "--print"};
  check.insert(check.end(), settings.begin(), settings.end());
  EXPECT_EQ(call(check).out, text_of(stored));
  EXPECT_EQ(call({"check", stored.string(), "--print"}).out, text_of(stored));

  ASSERT_EQ(run("again", stored.string(), {}).exit_code, 0);
  EXPECT_EQ(text_of(out() / "again/trajectory.txt"), text_of(out() / "run/trajectory.txt"));
  EXPECT_EQ(text_of(out() / "again/pipeline.yaml"), text_of(stored));
}

TEST_F(Run, NothingTrackedIsSaid) {
  const auto run_with = [&](const std::string& points) {
    return run("run", "orb_baseline",
               {"--dataset", simulated_recording().string(), "--set", "source.limit=3", "--set",
                "tracker.register_depth=false", "--set", "tracker.min_start_points=" + points});
  };
  EXPECT_THAT(run_with("100000").err, HasSubstr("warning: no frame was tracked"));
  EXPECT_THAT(run_with("100").err, ::testing::Not(HasSubstr("no frame was tracked")));
}

// As a daemon starts it: the files of the run must not take the places of the standard streams.
TEST_F(Run, WithoutStandardStreamsWritesWholeFiles) {
  const std::string command = "'" + program_file().string() + "' run orb_baseline --dataset '" +
                              simulated_recording().string() + "' -o '" + (out() / "run").string() +
                              "' <&- >&- 2>&-";
  EXPECT_EQ(std::system(command.c_str()), 0);
  expect_accurate("run");
  for (const char* file : {"frames.csv", "timings.csv"})
    EXPECT_EQ(text_of(out() / "run" / file).find("frames/s"), std::string::npos) << file;
}

// As `2>&1 | less` does when its window is full, or a terminal after Ctrl-S.
TEST_F(Run, GoesOnWhereNobodyReadsWhatItSays) {
  const fs::path pipe = out() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const int reader = ::open(pipe.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  ASSERT_GE(reader, 0);
  const std::string text(1024, 'x');
  while (::write(reader, text.data(), text.size()) > 0) continue;
  const std::string command = "'" + program_file().string() + "' run orb_baseline --dataset '" +
                              simulated_recording().string() + "' -o '" + (out() / "run").string() +
                              "' > /dev/null 2> '" + pipe.string() + "'";
  EXPECT_EQ(std::system(command.c_str()), 0);
  expect_accurate("run");
  ::close(reader);
}

}  // namespace
}  // namespace stillpoint::testing
