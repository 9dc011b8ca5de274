// stillpoint run on a recording that is whole: from the folder on disk to the trajectory.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "support/absolute_error.hpp"
#include "support/full_disk.hpp"
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

TEST_F(Run, EarlierRunIsReplaced) {
  for (const char* limit : {"4", "2"}) {
    const Outcome outcome = run("same", "orb_baseline",
                                {"--dataset", simulated_recording().string(), "--set",
                                 std::string("source.limit=") + limit});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(outcome.err.find("earlier run") != std::string::npos, *limit == '2');
  }
  EXPECT_EQ(count_poses(out() / "same/trajectory.txt"), 2u);
}

TEST_F(Run, EarlierRunInTheFolderStaysWhenThisOneCannotBegin) {
  const std::string recording = simulated_recording().string();
  const std::vector<std::string> good = {"--dataset", recording, "--set", "source.limit=2"};
  ASSERT_EQ(run("same", "orb_baseline", good).exit_code, 0);
  const std::string trajectory = text_of(out() / "same/trajectory.txt");
  const std::vector<std::vector<std::string>> bad = {
      {"--dataset", "/nowhere"},
      {"--dataset", recording, "--camera", "nobodys"},
      {"--dataset", recording, "--load-map", "/nowhere.map"},
      {"--dataset", recording, "--set", "segmenter.type=opencv_dnn", "--set",
       "segmenter.model=/nowhere.onnx"}};
  for (const auto& arguments : bad) {
    EXPECT_NE(run("same", "orb_baseline", arguments).exit_code, 0);
    EXPECT_EQ(text_of(out() / "same/trajectory.txt"), trajectory) << arguments.back();
    EXPECT_NE(run("new", "orb_baseline", arguments).exit_code, 0);
    EXPECT_FALSE(fs::exists(out() / "new")) << arguments.back();
  }
}

// Of a camera whose images have another size, only the first frame shows it.
TEST_F(Run, EarlierRunInTheFolderStaysWhenNoFrameIsUsable) {
  const TemporaryFolder folder;
  const fs::path camera = folder.write(
      "small.yaml", "camera: {width: 320, height: 240, fx: 262, fy: 262, cx: 160, cy: 120}\n");
  std::vector<std::string> arguments = {
      "--dataset",
      simulated_recording().string(),
      "--set",
      "source.limit=2",
      "--set",
      "map_backend.type=octomap",
      "--set",
      "outputs=[{type: trajectory}, {type: timings}, {type: mcap}, {type: images, every: 1}, "
      "{type: web, port: 0, record: w.html}]"};
  ASSERT_EQ(run("same", "orb_baseline", arguments).exit_code, 0);
  std::vector<fs::path> files;
  for (const char* name : {"trajectory.txt", "run.mcap", "log.txt", "pipeline.yaml",
                           "images/000001.jpg", "map/map.ot", "w.html"})
    files.push_back(out() / "same" / name);
  std::vector<std::string> texts;
  for (const fs::path& file : files) texts.push_back(text_of(file));
  arguments.insert(arguments.end(), {"--camera", camera.string()});
  for (const char* mode : {"inline", "threaded"}) {
    arguments.insert(arguments.end(), {"--set", std::string("runtime.mode=") + mode});
    const Outcome outcome = run("same", "orb_baseline", arguments);
    EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("source (tum_rgbd) failed on frame 0"));
    for (std::size_t i = 0; i < files.size(); ++i)
      EXPECT_TRUE(text_of(files[i]) == texts[i]) << files[i] << ", " << mode;
    EXPECT_THAT(outcome.err, HasSubstr("same still holds an earlier run"));
    EXPECT_EQ(run(mode, "orb_baseline", arguments).exit_code, 3);
    EXPECT_THAT(text_of(out() / mode / "log.txt"), HasSubstr("failed: source (tum_rgbd) failed"));
    EXPECT_EQ(std::distance(fs::directory_iterator(out() / mode), {}), 2) << "and pipeline.yaml";
  }
}

TEST_F(Run, FilesOfTheUserAreNotReplaced) {
  const std::string text = "version: 1\nextends: orb_baseline\n";
  const fs::path mine = out() / "mine";
  fs::create_directories(mine);
  std::ofstream(mine / "pipeline.yaml") << text;
  const Outcome outcome =
      run("mine", (mine / "pipeline.yaml").string(),
          {"--dataset", simulated_recording().string(), "--set", "source.limit=2"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("pipeline.yaml: is no file of an earlier run"));
  EXPECT_EQ(text_of(mine / "pipeline.yaml"), text);
}

TEST_F(Run, MapsAndPicturesOfTheUserStay) {
  const fs::path mine = out() / "mine";
  const auto files = {mine / "map/map.yaml", mine / "map/map.pgm", mine / "images/000001.jpg",
                      mine / "images/123456789.png"};
  for (const fs::path& file : files) {
    fs::create_directories(file.parent_path());
    std::ofstream(file) << "the user's";
  }
  const Outcome outcome =
      run("mine", "orb_baseline",
          {"--dataset", simulated_recording().string(), "--set", "source.limit=2"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("map.pgm: is no file of an earlier run"));
  for (const fs::path& file : files) EXPECT_EQ(text_of(file), "the user's") << file;
}

TEST_F(Run, ALogOfTheUserIsNoneOfARun) {
  const fs::path mine = out() / "mine";
  fs::create_directories(mine);
  std::ofstream(mine / "log.txt") << "Monday: rain\n";
  std::ofstream(mine / "trajectory.txt") << "of the user\n";
  const Outcome outcome =
      run("mine", "orb_baseline",
          {"--dataset", simulated_recording().string(), "--set", "source.limit=2"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("log.txt: is no file of an earlier run"));
  EXPECT_EQ(text_of(mine / "log.txt"), "Monday: rain\n");
  EXPECT_EQ(text_of(mine / "trajectory.txt"), "of the user\n");
}

TEST_F(Run, NothingTrackedIsSaid) {
  const auto run_with = [&](const std::string& points) {
    return run("run", "orb_baseline",
               {"--dataset", simulated_recording().string(), "--set", "source.limit=3", "--set",
                "tracker.hold_by_depth=false", "--set", "tracker.min_start_points=" + points});
  };
  EXPECT_THAT(run_with("100000").err, HasSubstr("warning: no frame was tracked"));
  EXPECT_THAT(run_with("100").err, ::testing::Not(HasSubstr("no frame was tracked")));
}

TEST_F(Run, WhereTheDiskIsFullTheEarlierRunStays) {
  const auto again = [&] {
    return run("same", "orb_baseline",
               {"--dataset", simulated_recording().string(), "--set", "source.limit=3"});
  };
  ASSERT_EQ(again().exit_code, 0);
  const std::string trajectory = text_of(out() / "same/trajectory.txt");
  const std::string log = text_of(out() / "same/log.txt");
  {
    const FullDisk full(1024);  // bytes; pipeline.yaml has more
    const Outcome outcome = again();
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("pipeline.yaml: cannot write: "));
    run("new", "orb_baseline", {"--dataset", simulated_recording().string()});
  }
  EXPECT_FALSE(fs::exists(out() / "new"));
  EXPECT_EQ(text_of(out() / "same/trajectory.txt"), trajectory);
  EXPECT_EQ(text_of(out() / "same/log.txt"), log);
  EXPECT_TRUE(fs::exists(out() / "same/summary.json"));
}

// In containers many processes have the same number.
TEST_F(Run, HalvesOfAKilledRunWithTheNumberOfThisProcessAreRemoved) {
  const fs::path folder = out() / "same";
  fs::create_directories(folder);
  const std::string script =
      "for i in 0 1 2; do echo half >\"$1/trajectory.txt.$$-$i.part\"; done; "
      "exec \"$0\" run orb_baseline --dataset \"$2\" -o \"$1\" --set source.limit=3";
  const Outcome outcome =
      call({"-c", script, program_file(), folder, simulated_recording()}, {.program = "/bin/sh"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(count_poses(folder / "trajectory.txt"), 3);
  for (const auto& entry : fs::directory_iterator(folder))
    EXPECT_NE(entry.path().extension(), ".part") << entry.path();
}

TEST_F(Run, EarlierPicturesDoNotOutliveTheirRun) {
  const auto run_with = [&](const std::vector<std::string>& settings) {
    std::vector<std::string> arguments = {"--dataset", simulated_recording().string(), "--set",
                                          "source.limit=3"};
    arguments.insert(arguments.end(), settings.begin(), settings.end());
    const Outcome outcome = run("same", "orb_baseline", arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  };
  const auto images = out() / "same/images";
  const std::string every_frame = "outputs=[{type: images, every: 1}]";
  run_with({"--set", every_frame});
  EXPECT_TRUE(fs::exists(images / "000002.jpg"));
  const auto halves = {out() / "same/trajectory.txt.4194304-0.part",
                       images / "000001.jpg.4194304-0.part"};
  for (const auto& half : halves) std::ofstream(half) << "of a run that was killed";
  std::ofstream(out() / "same/mine.txt.7-0.part") << "a file of the user's";
  std::ofstream(images / "mine.jpg") << "a picture of the user's";
  run_with({});
  for (const auto& half : halves) EXPECT_FALSE(fs::exists(half)) << half;
  EXPECT_TRUE(fs::exists(out() / "same/mine.txt.7-0.part"));
  EXPECT_FALSE(fs::exists(images / "000002.jpg"));
  EXPECT_TRUE(fs::exists(images / "mine.jpg"));
  fs::remove(images / "mine.jpg");
  run_with({"--set", every_frame});
  run_with({"--set", "outputs=[{type: images, every: 2}]"});
  EXPECT_FALSE(fs::exists(images / "000001.jpg"));
  EXPECT_TRUE(fs::exists(images / "000002.jpg"));
  run_with({});
  EXPECT_FALSE(fs::exists(images));
}

TEST_F(Run, EarlierDenseMapDoesNotOutliveItsRun) {
  const auto run_with = [&](const std::string& backend) {
    const Outcome outcome = run("same", "orb_baseline",
                                {"--dataset", simulated_recording().string(), "--set",
                                 "source.limit=3", "--set", "map_backend" + backend});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  };
  const auto map = out() / "same/map";
  run_with(".type=octomap");
  EXPECT_TRUE(std::filesystem::exists(map / "map.ot"));
  run_with(".type=voxel_cloud");
  EXPECT_FALSE(std::filesystem::exists(map / "map.ot"));
  EXPECT_TRUE(std::filesystem::exists(map / "cloud.ply"));
  run_with("=null");
  EXPECT_FALSE(std::filesystem::exists(map));
}

}  // namespace
}  // namespace stillpoint::testing
