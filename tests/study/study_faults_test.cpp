// What is wrong with a study is said before anything runs, with its place.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "ablate_fixture.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

using StudyFaults = AblateTest;

TEST_F(StudyFaults, AGridThatIsNoneIsRefusedWithItsPlace) {
  const auto refusal = [&](const std::string& grid) {
    folder_.write("study.yaml",
                  "version: 1\n"
                  "sequences: [{name: s, scene: fr3_walking_xyz_empty}]\n"
                  "variants: [{name: v, pipeline: orb_baseline, grid: " +
                      grid + "}]\n");
    const Outcome outcome =
        call({"ablate", (folder_.path() / "study.yaml").string(), "-o", out().string()});
    EXPECT_EQ(outcome.exit_code, 2);
    return outcome.err;
  };
  EXPECT_THAT(refusal("[1, 2]"),
              HasSubstr("study.yaml:3:52: error: a grid is written {OPTION: [VALUE, VALUE]}"));
  EXPECT_THAT(refusal("{}"), HasSubstr("a grid is written"));
  EXPECT_THAT(refusal("{tracker.features: []}"),
              HasSubstr("'tracker.features' of a grid needs its values"));
  EXPECT_THAT(refusal("{tracker.features: [[1]]}"),
              HasSubstr("a value of a grid is a number, a word or null"));
  EXPECT_THAT(refusal("{tracker.featurs: [1]}"), HasSubstr("did you mean 'features'?"));
}

// As of the recordings of real_people, of which there are 25.
TEST_F(StudyFaults, AVariableThatIsNotSetIsSaidOnce) {
  const Outcome outcome = ablate(
      "version: 1\n"
      "sequences:\n"
      "  - {name: a, dataset: '${STILLPOINT_TEST_UNSET}/a'}\n"
      "  - {name: b, dataset: '${STILLPOINT_TEST_UNSET}/b'}\n"
      "variants: [{name: v, pipeline: orb_baseline}]\n");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("study.yaml:3:24: error: environment variable "
                                     "'STILLPOINT_TEST_UNSET' is not set; set it"));
  EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
}

TEST_F(StudyFaults, NamesEveryFaultOfPublishedFigures) {
  const Outcome outcome =
      ablate(kShort +
             "published:\n"
             "  - name: Theirs\n"
             "    errors:\n"
             "      fr3_walking_xzy_empty: {ate_m: [0.1]}\n"
             "      fr3_walking_xyz_empty: {ate: [0.1], rpe_rotation_deg: [1, 2]}\n"
             "    times: {prepar_ms: 9, track_ms: -1}\n");
  EXPECT_EQ(outcome.exit_code, 2);
  for (const char* line :
       {"10:5: error: study.published[0]: 'source' is missing",
        "12:7: error: no recording named 'fr3_walking_xzy_empty'; did you mean "
        "'fr3_walking_xyz_empty'?",
        "13:7: error: study.published[0].errors.fr3_walking_xyz_empty: an error is [RMSE], or "
        "[RMSE, mean, median, S.D.]",
        "13:31: error: study.published[0].errors.fr3_walking_xyz_empty: unknown key 'ate'; known: "
        "ate_m, rpe_translation_m, rpe_rotation_deg",
        "14:13: error: study.published[0].times: unknown key 'prepar_ms'; did you mean "
        "'prepare_ms'?",
        "14:37: error: study.published[0].times.track_ms = -1 must be at least 0"})
    EXPECT_THAT(outcome.err, HasSubstr(line));
}

TEST_F(StudyFaults, WithoutAStudyItSaysWhereTheyAreListed) {
  const Outcome outcome = call({"ablate"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("needs a study; name a file, or one that 'stillpoint ablate "
                                     "--list' prints"));
}

TEST_F(StudyFaults, ABagIsNoRecordingOfAStudy) {
  const std::string bag = folder_.write("walk.bag", "").string();
  const Outcome outcome = ablate("version: 1\nsequences: [{name: walk, dataset: " + bag +
                                 "}]\nvariants: [{name: a, pipeline: orb_baseline}]\n");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("'stillpoint record PIPELINE --dataset BAG -o DIR'"));
}

TEST_F(StudyFaults, NamesEveryFaultOfAStudyWithItsPlace) {
  const Outcome outcome = ablate(
      "version: 1\n"
      "sequencs: []\n"
      "sequences:\n"
      "  - {name: a b, scene: fr3_walking_xzy}\n"
      "  - {name: c, dataset: nowhere, frames: 3}\n"
      "  - {name: d, scene: office, set: [source.frmaes=3]}\n"
      "  - {name: d, scene: office, dataset: nowhere, camera: tum_fr9}\n"
      "variants:\n"
      "  - {name: a, pipeline: orb_basline}\n"
      "  - {name: b, pipeline: orb_baseline, set: [tracker.fetures=500], skip: [e]}\n"
      "  - {name: c, pipeline: orb_baseline, set: [runtime.seed=3, 'outputs=[{type: summary}]']}\n"
      "baseline: z\n"
      "repeats: 0\n"
      "mode: inlin\n");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_FALSE(fs::exists(out()));
  std::vector<std::string> expected = {
      "2:1: error: study: unknown key 'sequencs'; did you mean 'sequences'?",
      "4:12: error: 'a b' also names a folder: letters, digits and _ - + . only",
      "4:24: error: no scene named 'fr3_walking_xzy'; did you mean 'fr3_walking_xyz'?",
      "5:5: error: study.sequences[1]: 'frames' and 'set' are for a 'scene'; they cannot "
      "change a recording",
      "/nowhere' is no folder",
      "6:35: error: --set source.frmaes=3: source: unknown key 'frmaes'; did you mean 'frames'?",
      "7:5: error: study.sequences[3]: needs either 'dataset', the folder of a recording, or "
      "'scene', to be simulated",
      "7:12: error: 'd' is given twice",
      "7:56: error: no camera named 'tum_fr9'; did you mean",
      "9:25: error: no pipeline named 'orb_basline'; did you mean 'orb_baseline'?",
      "10:44: error: --set tracker.fetures=500: tracker: unknown key 'fetures'; did you mean "
      "'features'?",
      "10:73: error: no sequence named 'e'; did you mean",
      "11:5: error: study.variants[2]: 'set' cannot change runtime.seed; write the study's 'seed' "
      "instead",
      "11:25: error: variant 'c': its pipeline has no output 'trajectory', from which the figures "
      "come",
      "12:11: error: no variant named 'z'; did you mean",
      "13:10: error: study.repeats = 0 is outside [1, 1000]",
      "14:7: error: study.mode = inlin is not one of pipeline, inline, threaded; did you mean "
      "'inline'?"};
  for (const std::string& line : expected) EXPECT_THAT(outcome.err, HasSubstr(line));
}

TEST_F(StudyFaults, WhatJobsAskForIsChecked) {
  const Outcome outcome = ablate(
      "version: 1\n"
      "sequences: [{name: s, scene: office}]\n"
      "variants: [{name: v, pipeline: orb_baseline}]\n"
      "slurm: {time: soon, memry: 1G, memory: lots, cpus: -1, options: [-p]}\n");
  EXPECT_EQ(outcome.exit_code, 2);
  for (const char* line :
       {"4:1: error: study.slurm: 'time' is written as sbatch reads it: 90 (minutes), 1:30:00, "
        "2-12",
        "4:1: error: study.slurm: 'memory' is written as sbatch reads it: 4G, 500M",
        "4:1: error: study.slurm: 'options' are written --NAME or --NAME=VALUE",
        "4:21: error: study.slurm: unknown key 'memry'; did you mean 'memory'?",
        "4:52: error: study.slurm.cpus = -1 is outside [0, 4096]"})
    EXPECT_THAT(outcome.err, HasSubstr(line));
  EXPECT_THAT(call({"ablate", "quick", "--executor", "slrum"}).err,
              HasSubstr("--executor: slrum not in {local,slurm}"));
}

TEST_F(StudyFaults, AnEmptyNameIsNoFolder) {
  fs::create_directories(out() / "recordings/mine");
  const Outcome outcome = ablate(
      "version: 1\n"
      "sequences: [{name: '', scene: office}]\n"
      "variants: [{name: v, pipeline: orb_baseline}]\n");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("'' also names a folder"));
  EXPECT_TRUE(fs::exists(out() / "recordings/mine"));
}

TEST_F(StudyFaults, ARecordingOfTheUserStays) {
  const fs::path mine = out() / "recordings/tiny/rgb.txt";
  fs::create_directories(mine.parent_path());
  std::ofstream(mine) << "# mine\n";
  const Outcome outcome = ablate(kShort);
  EXPECT_NE(outcome.exit_code, 0);
  EXPECT_THAT(outcome.err + outcome.out, HasSubstr("is no recording of a study"));
  EXPECT_TRUE(fs::exists(mine));
}

TEST_F(StudyFaults, AStudyWithoutVersionOrVariantsIsRefused) {
  const Outcome outcome = ablate("sequences: []\n");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("study.yaml:1:1: error: there is no version; write 'version: 1'"),
                    HasSubstr("study.yaml:1:1: error: study: 'variants' is missing"),
                    HasSubstr("study.yaml:1:12: error: sequences is empty")));
}

TEST_F(StudyFaults, AnUnknownStudyIsNamed) {
  const Outcome outcome = call({"ablate", "quik"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("no study named 'quik'; did you mean 'quick'?"));
}

TEST_F(StudyFaults, BrokenGroundTruthEndsBeforeAnyRun) {
  folder_.write("recording/groundtruth.txt", "1 2 3\n");
  const Outcome outcome = ablate(
      "version: 1\n"
      "sequences: [{name: s, dataset: recording}]\n"
      "variants: [{name: v, pipeline: orb_baseline}]\n");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("groundtruth.txt:1"));
  EXPECT_FALSE(fs::exists(out() / "runs"));
}

}  // namespace
}  // namespace stillpoint::testing
