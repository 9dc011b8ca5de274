// The folder of a run: earlier runs in it are replaced late, files of the user never.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "support/full_disk.hpp"
#include "support/simulated_recording.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class RunIntoFolder : public ::testing::Test {
 protected:
  // With these arguments after the pipeline; the run folder is `out` and the name.
  Outcome run(const std::string& name, const std::string& pipeline,
              std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"run", pipeline, "-o", (out() / name).string()});
    return call(std::move(arguments));
  }
  const fs::path& out() const { return folder_.path(); }

 private:
  TemporaryFolder folder_;
};

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

TEST_F(RunIntoFolder, EarlierPicturesDoNotOutliveTheirRun) {
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

// Numbered like those of a run, in the folder of one that wrote none.
TEST_F(RunIntoFolder, PicturesOfTheUserStayInTheFolderOfARunWithoutPictures) {
  const auto run_with = [&](const std::string& outputs) {
    return run("same", "orb_baseline",
               {"--dataset", simulated_recording().string(), "--set", "source.limit=3", "--set",
                "outputs=[{type: " + outputs + "}]"});
  };
  ASSERT_EQ(run_with("trajectory").exit_code, 0);
  const fs::path mine = out() / "same/images/000001.jpg";
  fs::create_directories(mine.parent_path());
  std::ofstream(mine) << "the user's";
  EXPECT_EQ(run_with("trajectory").exit_code, 0);
  EXPECT_EQ(text_of(mine), "the user's");
  const Outcome outcome = run_with("images, every: 1");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("000001.jpg: is no file of an earlier run"));
  EXPECT_EQ(text_of(mine), "the user's");
  EXPECT_EQ(count_poses(out() / "same/trajectory.txt"), 3u);
}

TEST_F(RunIntoFolder, PicturesAreThoseOfTheFoldersThatARunHasNamed) {
  const auto run_with = [&](const std::string& folder) {
    return run("same", "orb_baseline",
               {"--dataset", simulated_recording().string(), "--set", "source.limit=2", "--set",
                "outputs=[{type: images, every: 1, folder: " + folder + "}]"});
  };
  ASSERT_EQ(run_with("pics").exit_code, 0);
  const fs::path own = out() / "same/pics/000001.jpg", mine = out() / "same/images/000001.jpg";
  ASSERT_TRUE(fs::exists(own));
  fs::create_directories(mine.parent_path());
  std::ofstream(mine) << "the user's";
  EXPECT_EQ(run_with("others").exit_code, 0);
  EXPECT_FALSE(fs::exists(own));
  EXPECT_EQ(text_of(mine), "the user's");
  EXPECT_EQ(run_with("images").exit_code, 2);
  EXPECT_EQ(text_of(mine), "the user's");
  EXPECT_TRUE(fs::exists(out() / "same/others/000001.jpg"));
}

TEST_F(RunIntoFolder, EarlierDenseMapDoesNotOutliveItsRun) {
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
  EXPECT_THAT(text_of(out() / "same/files.txt"), HasSubstr(" map/cloud.ply\n"));
  run_with("=null");
  EXPECT_FALSE(std::filesystem::exists(map));
}

/// A line of the list of files that a run has written.
std::string listed(const fs::path& run, const std::string& name) {
  const auto written = fs::last_write_time(run / name).time_since_epoch().count();
  return std::to_string(fs::file_size(run / name)) + " " + std::to_string(written) + " " + name +
         "\n";
}

// As a back end of another plugin would leave them.
TEST_F(RunIntoFolder, FilesOfAnyBackEndDoNotOutliveTheirRunButThoseOfTheUserDo) {
  const auto run_again = [&] {
    const Outcome outcome =
        run("same", "orb_baseline",
            {"--dataset", simulated_recording().string(), "--set", "source.limit=3"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  };
  run_again();
  const fs::path folder = out() / "same", others = out() / "others";
  fs::create_directories(folder / "map/parts/of");
  fs::create_directories(others);
  fs::create_directory_symlink(others, folder / "map/link");
  const auto theirs = {"map/world.bin", "map/parts/of/it.bin"};
  const auto of_the_user = {"map/notes.txt", "map/changed.bin", "../others/precious.bin",
                            "map/link/linked.bin"};
  std::string list =
      "# Files of this run, which the next one into this folder removes: bytes, time, name\n";
  for (const char* name : theirs) {
    std::ofstream(folder / name) << "1";
    list += listed(folder, name);
  }
  for (const char* name : of_the_user) {
    std::ofstream(folder / name) << "1";
    if (name != std::string("map/notes.txt")) list += listed(folder, name);
  }
  std::ofstream(folder / "map/changed.bin") << "12";
  std::ofstream(folder / "files.txt") << list << "1 1 .\nx\n";
  run_again();
  for (const char* name : theirs) EXPECT_FALSE(fs::exists(folder / name)) << name;
  EXPECT_FALSE(fs::exists(folder / "map/parts"));
  for (const char* name : of_the_user) EXPECT_TRUE(fs::exists(folder / name)) << name;
}

TEST_F(RunIntoFolder, AListOfFilesOfTheUserIsNoneOfARun) {
  fs::create_directories(out() / "mine");
  std::ofstream(out() / "mine/files.txt") << "mine";
  const Outcome outcome =
      run("mine", "orb_baseline",
          {"--dataset", simulated_recording().string(), "--set", "source.limit=2"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("files.txt: is no file of an earlier run"));
}

// A folder on another disk, for example.
TEST_F(RunIntoFolder, LinksToFoldersStay) {
  fs::create_directories(out() / "elsewhere/run");
  fs::create_directories(out() / "elsewhere/map");
  fs::create_directory_symlink(out() / "elsewhere/run", out() / "link");
  fs::create_directory_symlink(out() / "elsewhere/map", out() / "link/map");
  for (int i = 0; i < 2; ++i) {
    const Outcome outcome = run("link/", "orb_baseline",
                                {"--dataset", simulated_recording().string(), "--set",
                                 "source.limit=2", "--set", "map_backend.type=voxel_cloud"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_TRUE(fs::is_symlink(out() / "link"));
    EXPECT_TRUE(fs::is_symlink(out() / "link/map"));
    EXPECT_TRUE(fs::exists(out() / "elsewhere/map/cloud.ply"));
  }
}

TEST_F(RunIntoFolder, WhatTheRunReadsIsNotRemoved) {
  const std::string map = (out() / "same/sparse.map").string();
  const std::vector<std::string> first = {
      "--dataset", simulated_recording().string(), "--set", "source.limit=3", "--save-map", map};
  ASSERT_EQ(run("same", "orb_baseline", first).exit_code, 0);
  const Outcome outcome =
      run("same", "orb_baseline",
          {"--dataset", simulated_recording().string(), "--load-map", map, "--localise-only"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("sparse.map: is a result of the earlier run in the folder"));
  EXPECT_TRUE(fs::exists(map));
}

// A name outside the folder is for the newest run, whichever folder it has.
TEST_F(RunIntoFolder, AFileElsewhereIsReplacedByTheRunThatNamesIt) {
  const std::string elsewhere = (out() / "latest.txt").string();
  for (const char* name : {"first", "second"}) {
    const Outcome outcome =
        run(name, "orb_baseline",
            {"--dataset", simulated_recording().string(), "--set", "source.limit=2", "--set",
             "outputs=[{type: trajectory, file: " + elsewhere + "}]"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(count_poses(elsewhere), 2u);
  }
}

TEST_F(RunIntoFolder, NoResultReplacesAnother) {
  for (const char* outputs :
       {"[{type: trajectory, file: a.txt}, {type: keyframes, file: x/../a.txt}]",
        "[{type: trajectory, file: log.txt}]"}) {
    const Outcome outcome = run(
        "same", "orb_baseline",
        {"--dataset", simulated_recording().string(), "--set", std::string("outputs=") + outputs});
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("two results of the run have this name"));
  }
}

TEST_F(RunIntoFolder, FilesThatOutputsNameDoNotOutliveTheirRun) {
  const auto run_with = [&](const std::string& outputs) {
    return run("same", "orb_baseline",
               {"--dataset", simulated_recording().string(), "--set", "source.limit=2", "--set",
                "outputs=[" + outputs + "]"});
  };
  const fs::path named = out() / "same/poses/a.txt", mine = out() / "same/b.txt";
  ASSERT_EQ(run_with("{type: trajectory, file: poses/a.txt}").exit_code, 0);
  ASSERT_TRUE(fs::exists(named));
  std::ofstream(mine) << "the user's";
  EXPECT_EQ(run_with("{type: trajectory, file: ./poses/a.txt}").exit_code, 0) << "the same";
  EXPECT_EQ(run_with("{type: trajectory, file: x/../b.txt}").exit_code, 2);
  const Outcome refused = run_with("{type: trajectory, file: b.txt}");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("b.txt: is no file of an earlier run, and would be replaced"));
  ASSERT_TRUE(fs::exists(named));
  EXPECT_EQ(run_with("{type: trajectory, file: trajectory.txt}").exit_code, 0);
  EXPECT_FALSE(fs::exists(named));
  EXPECT_FALSE(fs::exists(named.parent_path()));
  EXPECT_EQ(text_of(mine), "the user's");
}

}  // namespace
}  // namespace stillpoint::testing
