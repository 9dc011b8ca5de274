// The folder of a study: what `stillpoint ablate` takes for its own, and what it leaves alone.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "ablate_fixture.hpp"
#include "stillpoint/engine/folder_lock.hpp"
#include "support/plugin_libraries.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

using AblateFolder = AblateTest;

TEST_F(AblateFolder, ReplacesNothingThatWasMadeFromSomethingElse) {
  ASSERT_EQ(ablate(kShort).exit_code, 0);
  const std::string few = text_of(out() / "runs/tiny/few/0/trajectory.txt");
  const std::string results = text_of(out() / "results.csv");

  std::string changed = kShort;
  changed.replace(changed.find("=600"), 4, "=700");
  const Outcome refused = ablate(changed);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("1 of 2 runs there were made from another pipeline"));
  EXPECT_THAT(refused.err, HasSubstr("add --again to replace them"));

  std::string longer = kShort;
  longer.replace(longer.find("frames: 5"), 9, "frames: 8");
  const Outcome other_scene = ablate(longer);
  EXPECT_EQ(other_scene.exit_code, 2);
  EXPECT_THAT(other_scene.err, HasSubstr("recordings/tiny: is simulated from a scene that has"));

  // As a later version may write it.
  folder_.write("out/runs/tiny/many/0/result.json", "{\"version\": 7}");
  EXPECT_EQ(ablate(kShort).exit_code, 2);
  EXPECT_EQ(text_of(out() / "runs/tiny/few/0/trajectory.txt"), few);
  EXPECT_EQ(text_of(out() / "results.csv"), results);

  std::string more = kShort;  // a new variant replaces none
  more.replace(more.find("mode:"), 5, "  - {name: most, pipeline: orb_baseline}\nmode:");
  folder_.write("out/runs/tiny/many/0/result.json", "{");
  EXPECT_EQ(ablate(more).exit_code, 0);
}

// What runs made with it are made again; those of other pipelines stay, as does the program.
TEST_F(AblateFolder, AnotherBuildOfAPluginOfTheUserIsAnotherPipeline) {
  const fs::path plugin =
      folder_.write("mine/libstillpoint_good.so", text_of(plugin_library(kBadPlugins, "good")));
  folder_.write("mine.yaml", "version: 1\nextends: orb_baseline\nplugins: {paths: [mine]}\n");
  std::string study = kShort;
  study.replace(study.find("pipeline: orb_baseline"), 22, "pipeline: ./mine.yaml");
  ASSERT_EQ(ablate(study).exit_code, 0);
  EXPECT_EQ(ablate(study).err, "2 of 2 runs are there already\n");

  std::ofstream(plugin, std::ios::app) << '\n';
  const Outcome refused = ablate(study);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("1 of 2 runs there were made from another pipeline"));
  const Outcome again = ablate(study, {"--again"});
  EXPECT_THAT(again.err, AllOf(HasSubstr("[1/1] tiny/few/0: ATE"), HasSubstr("1 of 2 runs are "),
                               Not(HasSubstr("another build"))));
}

TEST_F(AblateFolder, AMovedStudyIsNotRunAnew) {
  ASSERT_EQ(ablate(kShort).exit_code, 0);
  fs::rename(out(), folder_.path() / "elsewhere");
  const std::string study = (folder_.path() / "study.yaml").string();
  const Outcome moved = call({"ablate", study, "-o", (folder_.path() / "elsewhere").string()});
  EXPECT_EQ(moved.err, "2 of 2 runs are there already\n");
}

TEST_F(AblateFolder, AFolderHoldsOneStudy) {
  ASSERT_EQ(ablate(kShort).exit_code, 0);
  EXPECT_THAT(text_of(out() / "study.json"), HasSubstr("\"command\": \"stillpoint ablate "));
  const std::string results = text_of(out() / "results.csv");
  const std::string other = folder_.write("other.yaml", kShort).string();
  const Outcome refused = call({"ablate", other, "-o", out().string()});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("holds the study 'study' ("), HasSubstr("not 'other' ("),
                                 HasSubstr("choose another folder with -o")));
  const std::string namesake = folder_.write("copies/study.yaml", kShort + "seed: 9\n").string();
  EXPECT_THAT(call({"ablate", namesake, "-o", out().string()}).err,
              HasSubstr("holds the study 'study' ("));
  EXPECT_EQ(text_of(out() / "results.csv"), results);

  folder_.write("copies/study.yaml", kShort);  // as another installation has it
  EXPECT_EQ(call({"ablate", namesake, "-o", out().string()}).exit_code, 0);
  folder_.write("out/study.json", "{\"study\": \"stu");
  const Outcome damaged = call({"ablate", namesake, "-o", out().string()});
  EXPECT_EQ(damaged.exit_code, 2);
  EXPECT_THAT(damaged.err, HasSubstr("study.json: does not say whose folder this is; remove it"));
}

TEST_F(AblateFolder, FilesOfTheUserAreNoResults) {
  for (const char* name : {"study.yaml", "results.md", "tables.tex"}) {
    folder_.write("out/" + std::string(name), "of the user");
    const Outcome refused = ablate(kShort);
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_THAT(refused.err, HasSubstr(std::string(name) +
                                       ": is no file of an earlier study, and would be replaced"));
    EXPECT_EQ(text_of(out() / name), "of the user");
    fs::remove(out() / name);
  }
  EXPECT_TRUE(fs::is_empty(out()));
}

TEST_F(AblateFolder, WhatTheUserPutsIntoTheFolderOfARunStays) {
  ASSERT_EQ(ablate(kShort).exit_code, 0);
  const fs::path run = out() / "runs/tiny/few/0";
  folder_.write("out/runs/tiny/few/0/notes.txt", "mine");
  folder_.write("out/runs/tiny/few/0/map/photograph.jpg", "mine");
  std::string changed = kShort;
  changed.replace(changed.find("=600"), 4, "=700");
  EXPECT_THAT(ablate(changed, {"--again"}).err, HasSubstr("[1/1] tiny/few/0: ATE"));
  EXPECT_THAT(text_of(run / "pipeline.yaml"), HasSubstr("features: 700"));
  EXPECT_EQ(text_of(run / "notes.txt"), "mine");

  for (const char* file : {"result.json", "cell_files.txt"})
    fs::remove(run / file);  // as if killed
  EXPECT_THAT(ablate(changed).err, HasSubstr("[1/1] tiny/few/0: ATE"));
  EXPECT_EQ(text_of(run / "notes.txt"), "mine");
  EXPECT_EQ(text_of(run / "map/photograph.jpg"), "mine");
}

TEST_F(AblateFolder, ARecordingIntoWhichTheUserHasPutFilesIsNotReplaced) {
  ASSERT_EQ(ablate(kShort).exit_code, 0);
  folder_.write("out/recordings/tiny/masks/0.png", "mine");
  std::string longer = kShort;
  longer.replace(longer.find("frames: 5"), 9, "frames: 8");
  const Outcome refused = ablate(longer, {"--again"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("recordings/tiny/masks: is no file of the simulated "
                                     "recording that would be replaced; move it"));
  EXPECT_EQ(text_of(out() / "recordings/tiny/masks/0.png"), "mine");
  fs::remove_all(out() / "recordings/tiny/masks");
  EXPECT_EQ(ablate(longer, {"--again"}).exit_code, 0);
}

TEST_F(AblateFolder, AFolderIsOfOneProcessAtATime) {
  ASSERT_EQ(ablate(kShort).exit_code, 0);
  fs::remove_all(out() / "runs/tiny/many");
  const FolderLock lock(out());
  for (const char* executor : {"local", "slurm"}) {
    const Outcome refused = ablate(kShort, {"--again", "--executor", executor});
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_THAT(refused.err, HasSubstr("another run or study is writing into this folder"));
  }
  EXPECT_FALSE(fs::exists(out() / "runs/tiny/many"));
  EXPECT_TRUE(fs::exists(out() / "runs/tiny/few/0/trajectory.txt"));
}

TEST_F(AblateFolder, OnlyItsOwnHalfRecordingsAreRemoved) {
  folder_.write("out/recordings/tiny.4242.part/rgb.txt", "of a study that was killed");
  folder_.write("out/recordings/tiny.4242.part.txt", "what its simulator said");
  folder_.write("out/recordings/tiny.2024.part/rgb.txt", "mine");
  folder_.write("out/recordings/tiny.part/rgb.txt", "mine");
  folder_.write("out/recordings/tiny.txt", "mine");
  ASSERT_EQ(ablate(kShort).exit_code, 0);
  EXPECT_FALSE(fs::exists(out() / "recordings/tiny.4242.part"));
  EXPECT_FALSE(fs::exists(out() / "recordings/tiny.4242.part.txt"));
  EXPECT_EQ(text_of(out() / "recordings/tiny.2024.part/rgb.txt"), "mine");
  EXPECT_EQ(text_of(out() / "recordings/tiny.part/rgb.txt"), "mine");
  EXPECT_EQ(text_of(out() / "recordings/tiny.txt"), "mine");
}

}  // namespace
}  // namespace stillpoint::testing
