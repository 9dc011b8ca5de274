// The folder of a run: earlier runs in it are replaced late, files of the user never.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "run_folder_fixture.hpp"
#include "support/full_disk.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

TEST_F(RunIntoFolder, EarlierRunIsReplaced) {
  for (const char* limit : {"4", "2"}) {
    const Outcome outcome = run("same", "orb_baseline",
                                {"--dataset", simulated_recording().string(), "--set",
                                 std::string("source.limit=") + limit});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(outcome.err.find("earlier run") != std::string::npos, *limit == '2');
  }
  EXPECT_EQ(count_poses(out() / "same/trajectory.txt"), 2u);
}

TEST_F(RunIntoFolder, EarlierRunInTheFolderStaysWhenThisOneCannotBegin) {
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
TEST_F(RunIntoFolder, EarlierRunInTheFolderStaysWhenNoFrameIsUsable) {
  const TemporaryFolder folder;
  const fs::path camera = folder.write("small.yaml",
                                       "camera: {width: 320, height: 240, fx: 262, fy: 262, cx: "
                                       "160, cy: 120, depth_factor: 5000}\n");
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

TEST_F(RunIntoFolder, FilesOfTheUserAreNotReplaced) {
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

TEST_F(RunIntoFolder, MapsAndPicturesOfTheUserStay) {
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

TEST_F(RunIntoFolder, ALogOfTheUserIsNoneOfARun) {
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

TEST_F(RunIntoFolder, WhereTheDiskIsFullTheEarlierRunStays) {
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
TEST_F(RunIntoFolder, HalvesOfAKilledRunWithTheNumberOfThisProcessAreRemoved) {
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

}  // namespace
}  // namespace stillpoint::testing
