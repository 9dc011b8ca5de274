// `stillpoint ablate` as a user calls it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <string>
#include <vector>

#include "ablate_fixture.hpp"
#include "support/full_disk.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

using Ablate = AblateTest;

TEST_F(Ablate, RunsTheMatrixOnceAndThenWhatIsMissing) {
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

  const Outcome second = ablate(kTiny, {"-j", "2"});
  EXPECT_EQ(second.exit_code, 0);
  EXPECT_EQ(second.err, "2 of 2 runs are there already\n");
  EXPECT_EQ(text_of(out() / "results.csv"), csv);

  fs::remove_all(out() / "runs/tiny/many");
  const Outcome third = ablate(kTiny);
  EXPECT_THAT(third.err, AllOf(HasSubstr("[1/1] tiny/many/0"), Not(HasSubstr("simulating"))));

  std::string changed = kTiny;
  changed.replace(changed.find("=600"), 4, "=700");
  EXPECT_THAT(ablate(changed, {"--again"}).err, HasSubstr("[1/1] tiny/few/0"));

  std::string longer = kTiny;
  longer.replace(longer.find("frames: 30"), 10, "frames: 8");
  EXPECT_THAT(ablate(longer, {"--again"}).err,
              AllOf(HasSubstr("simulating tiny"), HasSubstr("[2/2]")));
}

TEST_F(Ablate, OnAFullDiskTheStudyStaysAsItWasAndGoesOn) {
  ASSERT_EQ(ablate(kShort).exit_code, 0);
  const auto files = {out() / "results.csv", out() / "results.md", out() / "tables.tex",
                      out() / "study.yaml", out() / "runs/tiny/few/0/trajectory.txt"};
  std::vector<std::string> before;
  for (const fs::path& file : files) before.push_back(text_of(file));
  fs::remove_all(out() / "runs/tiny/many");
  {
    const FullDisk full(1024);  // bytes
    const Outcome outcome = ablate(kShort);
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("study.yaml: cannot write: "));
  }
  std::vector<std::string> after;
  for (const fs::path& file : files) after.push_back(text_of(file));
  EXPECT_EQ(after, before);
  for (const auto& entry : fs::recursive_directory_iterator(out()))
    EXPECT_NE(entry.path().extension(), ".part") << entry.path();
  const Outcome resumed = ablate(kShort);
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_THAT(resumed.err, HasSubstr("[1/1] tiny/many/0: ATE"));
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

TEST_F(Ablate, OneThatIsStoppedBeforeItsFirstRunLeavesWhatIsThere) {
  ASSERT_EQ(ablate(kShort).exit_code, 0);
  const std::string tables = text_of(out() / "results.md"), study = text_of(out() / "study.yaml");
  std::string longer = kShort;
  longer.replace(longer.find("frames: 5"), 9, "frames: 800");
  const fs::path file = folder_.write("study.yaml", longer);
  Program program({"ablate", file.string(), "-o", out().string(), "--again"});
  ASSERT_TRUE(program.wait_for("simulating"));
  program.send(SIGINT);
  EXPECT_EQ(program.finish().signal, SIGINT);
  EXPECT_EQ(text_of(out() / "results.md"), tables);
  EXPECT_EQ(text_of(out() / "study.yaml"), study);
}

TEST_F(Ablate, ResultsOfAnEarlierStudyAreGoneAsSoonAsItIsRunAgain) {
  const std::string study = std::string(kTiny) + "repeats: 3\n";
  ASSERT_EQ(ablate(study).exit_code, 0);
  std::string changed = study;
  changed.replace(changed.find("=600"), 4, "=700").replace(changed.find("=1000"), 5, "=1100");
  const fs::path file = folder_.write("study.yaml", changed);
  Program program({"ablate", file.string(), "-o", out().string(), "--again"});
  ASSERT_TRUE(program.wait_for("[1/6]"));
  program.send(SIGINT);
  EXPECT_EQ(program.finish().signal, SIGINT);
  EXPECT_FALSE(fs::exists(out() / "runs/tiny/many/2/result.json"));
}

TEST_F(Ablate, NullOfAGridLeavesAStageOut) {
  folder_.write("study.yaml",
                "version: 1\n"
                "sequences: [{name: s, scene: fr3_walking_xyz_empty, frames: 3}]\n"
                "variants:\n"
                "  - name: v\n"
                "    pipeline: orb_baseline\n"
                "    grid: {loop_closer: [null], tracker.features: [500]}\n");
  const Outcome outcome =
      call({"ablate", (folder_.path() / "study.yaml").string(), "-o", out().string()});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(text_of(out() / "runs/s/v-loop_closer-null-features-500/0/pipeline.yaml"),
              Not(HasSubstr("\nloop_closer:")));
}

TEST_F(Ablate, WhileJobsMayBeInTheQueueNothingRunsHere) {
  ASSERT_EQ(ablate(kShort).exit_code, 0);
  fs::remove_all(out() / "runs/tiny/many");
  folder_.write("out/slurm/1/sbatch.txt", "4711\n");
  const Outcome refused =
      call({"ablate", (folder_.path() / "study.yaml").string(), "-o", out().string()},
           {.environment = {{"PATH", "/nowhere"}}});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("were given to Slurm, which does not say whether they go on"));
  EXPECT_FALSE(fs::exists(out() / "runs/tiny/many"));
  EXPECT_TRUE(fs::exists(out() / "runs/tiny/few/0/result.json"));
}

TEST_F(Ablate, TheCommandIsThatWhichRepeatsTheStudy) {
  ASSERT_EQ(ablate(kShort, {"-j", "2"}).exit_code, 0);
  const std::string command = "stillpoint ablate " + (folder_.path() / "study.yaml").string() +
                              " -o " + out().string() + " -j 2";
  for (const char* file : {"study.json", "results.md", "results.csv", "summary.csv", "tables.tex"})
    EXPECT_THAT(text_of(out() / file), HasSubstr(command)) << file;
}

TEST_F(Ablate, TheFirstRepeatKeepsPicturesOfItsWorstFrames) {
  ASSERT_EQ(ablate(kShort + "pictures: 1\nrepeats: 2\n").exit_code, 0);
  EXPECT_TRUE(fs::exists(out() / "runs/tiny/few/0/images/000000.jpg"));
  EXPECT_THAT(text_of(out() / "runs/tiny/few/0/pipeline.yaml"),
              AllOf(HasSubstr("worst: 1 "), HasSubstr("panels: true ")));
  EXPECT_FALSE(fs::exists(out() / "runs/tiny/few/1/images"));
  const Outcome report = call({"report", out().string()});
  EXPECT_EQ(report.exit_code, 0) << report.err;
  EXPECT_THAT(text_of(out() / "report.html"), HasSubstr("id=\"picture-0-0\">"));
  EXPECT_EQ(ablate(kShort + "repeats: 2\n").err, "4 of 4 runs are there already\n");
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
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("Theirs (published)"), HasSubstr("measured here: Theirs (Table I)"),
                    HasSubstr("## Time of each stage"),
                    HasSubstr("## RMSE, mean, median and standard deviation")));
  EXPECT_THAT(text_of(out() / "tables.tex"), HasSubstr("\\textit{0.1250}"));
  EXPECT_THAT(text_of(out() / "summary.csv"),
              AllOf(HasSubstr("tiny,few,ate_sd_m,1,"), HasSubstr("tiny,few,track_ms,1,")));
}

constexpr const char* kLong =
    "version: 1\n"
    "sequences: [{name: s, scene: fr3_walking_xyz_empty, frames: 20}]\n"
    "variants: [{name: v, pipeline: orb_baseline}]\n"
    "repeats: 1000\n";

TEST_F(Ablate, AKilledStudyHasAReport) {
  folder_.write("study.yaml", kLong);
  Program program({"ablate", (folder_.path() / "study.yaml").string(), "-o", out().string()});
  ASSERT_TRUE(program.wait_for("[2/1000]"));
  program.send(SIGKILL);
  EXPECT_EQ(program.finish().signal, SIGKILL);
  const Outcome outcome = call({"report", out().string()});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(text_of(out() / "report.tex"), HasSubstr("of 1000 runs"));
}

TEST_F(Ablate, CtrlCKeepsWhatIsDone) {
  folder_.write("study.yaml", kLong);
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

}  // namespace
}  // namespace stillpoint::testing
