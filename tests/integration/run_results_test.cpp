// Which files are results of a run, and go with the next one into the folder: pictures, dense maps,
// what outputs name, and no file of the user.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "run_folder_fixture.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

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

TEST_F(RunIntoFolder, ABagOfTheEarlierRunIsNotRemovedByTheRunThatReadsIt) {
  const std::string recording = simulated_recording().string();
  ASSERT_EQ(run("same", "orb_baseline",
                {"--dataset", recording, "--set", "source.limit=2", "--with", "mcap"})
                .exit_code,
            0);
  const std::string bag = (out() / "same/run.mcap").string();
  for (const std::vector<std::string>& named :
       {std::vector<std::string>{"--dataset", bag}, {"--set", "source.path=" + bag}}) {
    const Outcome outcome = run("same", "orb_baseline", named);
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("run.mcap: is a result of the earlier run in the folder"));
  }
  EXPECT_TRUE(fs::exists(bag));
}

TEST_F(RunIntoFolder, TheSparseMapReplacesNoOtherResult) {
  for (const char* result : {"trajectory.txt", "log.txt", "map/../summary.json"}) {
    const Outcome outcome =
        run("new", "orb_baseline",
            {"--dataset", simulated_recording().string(), "--set", "source.limit=2", "--save-map",
             (out() / "new" / result).string()});
    EXPECT_EQ(outcome.exit_code, 2) << result;
    EXPECT_THAT(outcome.err, HasSubstr("two results of the run have this name"));
  }
  EXPECT_FALSE(fs::exists(out() / "new/trajectory.txt"));
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
