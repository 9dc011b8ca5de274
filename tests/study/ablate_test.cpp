// `stillpoint ablate` as a user calls it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <string>

#include "support/program.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class Ablate : public ::testing::Test {
 protected:
  Outcome ablate(const std::string& text, std::vector<std::string> more = {}) {
    const std::string file = folder_.write("study.yaml", text).string();
    std::vector<std::string> arguments = {"ablate", file, "-o", out().string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return call(arguments);
  }
  fs::path out() const { return folder_.path() / "out"; }

  TemporaryFolder folder_;
};

constexpr const char* kTiny =
    "version: 1\n"
    "sequences:\n"
    "  - {name: tiny, scene: fr3_walking_xyz_empty, frames: 30}\n"
    "variants:\n"
    "  - {name: few, pipeline: orb_baseline, set: [tracker.features=600]}\n"
    "  - {name: many, pipeline: orb_baseline, set: [tracker.features=1000]}\n"
    "mode: inline\n"
    "baseline: few\n";

TEST_F(Ablate, RunsTheMatrixOnceAndThenWhatIsMissingOrChanged) {
  const Outcome first = ablate(kTiny, {"-j", "2"});
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_THAT(first.err, AllOf(HasSubstr("simulating tiny"), HasSubstr("[2/2] tiny/")));
  EXPECT_THAT(first.out, AllOf(HasSubstr("## Absolute trajectory error"), HasSubstr("| tiny "),
                               HasSubstr("## Improvement of the ATE over few")));
  EXPECT_THAT(first.out, HasSubstr(text_of(out() / "results.md")));
  const std::string csv = text_of(out() / "results.csv");
  EXPECT_THAT(csv,
              AllOf(HasSubstr("\ntiny,few,0,1,done,0,0.0"), HasSubstr("\ntiny,many,0,1,done,0,")));
  EXPECT_TRUE(fs::exists(out() / "runs/tiny/few/0/trajectory.txt"));

  const Outcome second = ablate(kTiny);
  EXPECT_EQ(second.exit_code, 0);
  EXPECT_EQ(second.err, "2 of 2 runs are there already\n");
  EXPECT_EQ(text_of(out() / "results.csv"), csv);

  fs::remove_all(out() / "runs/tiny/many");
  const Outcome third = ablate(kTiny);
  EXPECT_THAT(third.err, AllOf(HasSubstr("[1/1] tiny/many/0"), Not(HasSubstr("simulating"))));

  std::string changed = kTiny;
  changed.replace(changed.find("=600"), 4, "=700");
  EXPECT_THAT(ablate(changed).err, HasSubstr("[1/1] tiny/few/0"));

  std::string longer = kTiny;
  longer.replace(longer.find("frames: 30"), 10, "frames: 8");
  EXPECT_THAT(ablate(longer).err, AllOf(HasSubstr("simulating tiny"), HasSubstr("[2/2]")));
}

TEST_F(Ablate, AFailedRunIsListedAndTheOthersGoOn) {
  const fs::path recording = folder_.path() / "recording";
  ASSERT_EQ(call({"simulate", "fr3_walking_xyz_empty", "--frames", "8", "-o", recording.string()})
                .exit_code,
            0);
  const fs::path damaged = folder_.path() / "damaged";
  fs::copy(recording, damaged, fs::copy_options::recursive);
  fs::remove(damaged / "depth.txt");
  fs::remove(damaged / "associations.txt");
  const Outcome outcome = ablate(
      "version: 1\n"
      "sequences:\n"
      "  - {name: damaged, dataset: damaged}\n"
      "  - {name: good, dataset: recording}\n"
      "variants:\n"
      "  - {name: plain, pipeline: orb_baseline}\n");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("damaged/plain/0: FAILED (exit code 3)"),
                    HasSubstr("good/plain/0: ATE"), HasSubstr("error: 1 of 2 runs failed")));
  EXPECT_THAT(outcome.out, HasSubstr("* damaged/plain/0: exit code 3: "));
  EXPECT_THAT(text_of(out() / "results.csv"), HasSubstr("\ndamaged,plain,0,1,failed,3,"));
}

TEST_F(Ablate, AGridIsAVariantForEveryCombination) {
  folder_.write("study.yaml",
                "version: 1\n"
                "sequences: [{name: s, scene: fr3_walking_xyz_empty, frames: 3}]\n"
                "variants:\n"
                "  - {name: plain, pipeline: orb_baseline}\n"
                "  - name: more\n"
                "    pipeline: orb_baseline\n"
                "    set: [tracker.features=900]\n"
                "    grid: {tracker.features: [500, 1000], runtime.mode: [inline, threaded]}\n");
  const Outcome outcome =
      call({"ablate", (folder_.path() / "study.yaml").string(), "-o", out().string()});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::string effective =
      text_of(out() / "runs/s/more-features-500-mode-threaded/0/pipeline.yaml");
  EXPECT_THAT(effective, AllOf(HasSubstr("features: 500"), HasSubstr("mode: threaded")));
  EXPECT_THAT(text_of(out() / "results.csv"),
              AllOf(HasSubstr("\ns,plain,"), HasSubstr("\ns,more-features-500-mode-inline,"),
                    HasSubstr("\ns,more-features-1000-mode-inline,"),
                    HasSubstr("\ns,more-features-1000-mode-threaded,")));
}

TEST_F(Ablate, AGridThatIsNoneIsRefusedWithItsPlace) {
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
              HasSubstr("a value of a grid is a number or a word"));
  EXPECT_THAT(refusal("{tracker.featurs: [1]}"), HasSubstr("did you mean 'features'?"));
}

/// The same in a few frames, for what happens around the runs.
const std::string kShort = [] {
  std::string text = kTiny;
  return text.replace(text.find("frames: 30"), 10, "frames: 5");
}();

TEST_F(Ablate, AMovedStudyIsNotRunAnew) {
  ASSERT_EQ(ablate(kShort).exit_code, 0);
  fs::rename(out(), folder_.path() / "elsewhere");
  const std::string study = (folder_.path() / "study.yaml").string();
  const Outcome moved = call({"ablate", study, "-o", (folder_.path() / "elsewhere").string()});
  EXPECT_EQ(moved.err, "2 of 2 runs are there already\n");
}

TEST_F(Ablate, AFolderHoldsOneStudy) {
  ASSERT_EQ(ablate(kShort).exit_code, 0);
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

TEST_F(Ablate, HalfWrittenResultsAreMadeAgain) {
  ASSERT_EQ(ablate(kShort).exit_code, 0);
  truncate_file(out() / "runs/tiny/few/0/result.json", 0.5);
  folder_.write("out/runs/tiny/many/0/result.json", "[]");
  const Outcome again = ablate(kShort);
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_THAT(again.err, AllOf(HasSubstr("[2/2] tiny/"), Not(HasSubstr("simulating"))));
}

TEST_F(Ablate, PublishedFiguresStandBesideThoseOfTheRuns) {
  const Outcome outcome = ablate(kShort +
                                 "published:\n"
                                 "  - name: Theirs\n"
                                 "    source: Table I\n"
                                 "    errors: {fr3_walking_xyz_empty: {ate_m: [0.125]}}\n"
                                 "    times: {prepare_ms: 9.5}\n");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, ::testing::ContainsRegex("\\| tiny .*\\| 0.1250 +\\|"));
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("Theirs (published)"), HasSubstr("* Theirs: Table I"),
                                 HasSubstr("## Time of each stage"),
                                 HasSubstr("## RMSE, mean, median and standard deviation")));
  EXPECT_THAT(text_of(out() / "tables.tex"), HasSubstr("\\textit{0.1250}"));
  EXPECT_THAT(text_of(out() / "summary.csv"),
              AllOf(HasSubstr("tiny,few,ate_sd_m,1,"), HasSubstr("tiny,few,track_ms,1,")));
}

TEST_F(Ablate, NamesEveryFaultOfPublishedFigures) {
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

TEST_F(Ablate, WithoutAStudyItSaysWhereTheyAreListed) {
  const Outcome outcome = call({"ablate"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("needs a study; name a file, or one that 'stillpoint ablate "
                                     "--list' prints"));
}

TEST_F(Ablate, CtrlCKeepsWhatIsDone) {
  folder_.write("study.yaml",
                "version: 1\n"
                "sequences: [{name: s, scene: fr3_walking_xyz_empty, frames: 20}]\n"
                "variants: [{name: v, pipeline: orb_baseline}]\n"
                "repeats: 1000\n");
  Program program({"ablate", (folder_.path() / "study.yaml").string(), "-o", out().string()});
  ASSERT_TRUE(program.wait_for("[2/1000]"));
  program.send(SIGINT);
  const Outcome outcome = program.finish();
  EXPECT_EQ(outcome.signal, SIGINT);
  EXPECT_THAT(outcome.err, HasSubstr("stopped; the same command resumes the study"));
  EXPECT_THAT(outcome.out, HasSubstr("**Not finished:**"));
  EXPECT_THAT(text_of(out() / "results.csv"),
              AllOf(HasSubstr("\ns,v,0,1,done,"), HasSubstr("\ns,v,1,2,done,"),
                    HasSubstr("\ns,v,999,1000,missing,")));
}

TEST_F(Ablate, NamesEveryFaultOfAStudyWithItsPlace) {
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

TEST_F(Ablate, WhatJobsAskForIsChecked) {
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

TEST_F(Ablate, AnEmptyNameIsNoFolder) {
  fs::create_directories(out() / "recordings/mine");
  const Outcome outcome = ablate(
      "version: 1\n"
      "sequences: [{name: '', scene: office}]\n"
      "variants: [{name: v, pipeline: orb_baseline}]\n");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("'' also names a folder"));
  EXPECT_TRUE(fs::exists(out() / "recordings/mine"));
}

TEST_F(Ablate, AStudyWithoutVersionOrVariantsIsRefused) {
  const Outcome outcome = ablate("sequences: []\n");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("study.yaml:1:1: error: there is no version; write 'version: 1'"),
                    HasSubstr("study.yaml:1:1: error: study: 'variants' is missing"),
                    HasSubstr("study.yaml:1:12: error: sequences is empty")));
}

TEST_F(Ablate, AnUnknownStudyIsNamed) {
  const Outcome outcome = call({"ablate", "quik"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("no study named 'quik'; did you mean 'quick'?"));
}

TEST_F(Ablate, BrokenGroundTruthEndsBeforeAnyRun) {
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
