// `stillpoint report` as a user calls it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <nlohmann/json.hpp>

#include "finished_run.hpp"
#include "report/page_json.hpp"
#include "report/report_reader.hpp"
#include "report/run_reader.hpp"
#include "study/cell_result.hpp"
#include "support/full_disk.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

TEST(RunReader, HasAllThatARunHasLeft) {
  const report::RunData run = report::read_run(finished_run(), "name");
  EXPECT_THAT(run.notes, IsEmpty());
  EXPECT_TRUE(run.complete);
  EXPECT_EQ(run.recording, recording_with_people().filename());
  EXPECT_THAT(run.made_by, HasSubstr("cores; 20"));
  ASSERT_TRUE(run.evaluation);
  EXPECT_LT(run.evaluation->rigid.metres.rmse, 0.02);
  ASSERT_EQ(run.frame_rows.size(), static_cast<std::size_t>(kSimulatedFrames));
  EXPECT_EQ(run.trace.size(), run.evaluation->pairs.size());
  // The moments of all series are those of the recording, up to half an interval of the truth.
  EXPECT_NEAR(run.trace.back().seconds, run.frame_rows.back().seconds, 0.006);
  EXPECT_GT(run.frame_rows.back().inliers, 100);
  EXPECT_FALSE(run.stages.empty());
  EXPECT_FALSE(run.pictures.empty());
  EXPECT_FALSE(run.octree.empty());
  EXPECT_EQ(run.live_view, finished_run() / "live.html");
  double largest = 0.0;
  for (const report::TracePoint& point : run.trace)
    largest = std::max(largest, std::abs((point.truth - point.estimate).norm() - point.error_m));
  EXPECT_LT(largest, 1e-9);
}

TEST(ReportProgram, WritesPageAndTablesOfARunAndChangesNothingElse) {
  SKIP_WITHOUT_PAGE();
  const TemporaryFolder folder;
  const fs::path page = folder.path() / "new/page.html";
  const std::string before = text_of(finished_run() / "summary.json");
  const Outcome outcome = call({"report", finished_run().string(), "-o", page.string()});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("page.html"), HasSubstr("tables: page.tex, page.csv")));
  EXPECT_THAT(text_of(page), AllOf(HasSubstr("id=\"report\">"), HasSubstr("id=\"run-0\">"),
                                   HasSubstr("id=\"map-0\">"), HasSubstr("id=\"picture-0-0\">"),
                                   HasSubstr("id=\"replay-0\">")));
  const std::string command =
      "stillpoint report '" + finished_run().string() + "' -o " + page.string();
  EXPECT_THAT(text_of(folder.path() / "new/page.tex"),
              AllOf(HasSubstr("\n% " + command + "\n% Stillpoint "), HasSubstr("\\toprule")));
  EXPECT_THAT(
      text_of(folder.path() / "new/page.csv"),
      AllOf(HasSubstr("Runs,a run,ATE RMSE (m),0.0"), HasSubstr(command + " | Stillpoint ")));
  EXPECT_EQ(text_of(finished_run() / "summary.json"), before);
  EXPECT_FALSE(fs::exists(finished_run() / "report.html"));
}

TEST(ReportProgram, WritesEveryFigureWhereItIsAsked) {
  SKIP_WITHOUT_PAGE();
  const TemporaryFolder folder;
  const Outcome outcome =
      call({"report", finished_run().string(), "-o", (folder.path() / "page.html").string(),
            "--figures", (folder.path() / "figures").string()});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("6 figures in "));
  const fs::path figures = folder.path() / "figures" / recording_with_people().filename() / "a_run";
  for (const char* name :
       {"trajectory", "errors", "excluded", "features", "stage_times", "frame_times"}) {
    EXPECT_THAT(text_of(figures / (std::string(name) + ".svg")), HasSubstr("<svg")) << name;
    EXPECT_THAT(text_of(figures / (std::string(name) + ".pdf")), HasSubstr("%PDF-1.")) << name;
  }
}

TEST(ReportProgram, SaysWhatALoneRunDiffersInFromItsFile) {
  const report::RunData run = report::read_run(finished_run(), "name");
  EXPECT_EQ(run.pipeline.filename(), "stillpoint.yaml");
}

TEST(ReportProgram, SeveralRunsAreComparedWithTheFirst) {
  const TemporaryFolder folder;
  const fs::path other = folder.path() / "other";
  fs::copy(finished_run(), other, fs::copy_options::recursive);
  std::string yaml = text_of(other / "pipeline.yaml");
  const std::string option = "  interval_seconds: 0.1";
  yaml.replace(yaml.find(option), option.size(), "  interval_seconds: 0.2");
  folder.write("other/pipeline.yaml", yaml);
  const report::ReportData data = report::read_runs({finished_run(), other});
  ASSERT_EQ(data.runs.size(), 2u);
  EXPECT_THAT(data.runs[0].changes, IsEmpty());
  ASSERT_EQ(data.runs[1].changes.size(), 1u);
  EXPECT_EQ(data.runs[1].changes[0].key, "segmentation.interval_seconds");
  EXPECT_EQ(data.runs[1].changes[0].base, "0.1");
  EXPECT_EQ(data.runs[1].base, "a run");
}

TEST(ReportProgram, SeveralRunsAreReportedInTheWorkingFolder) {
  SKIP_WITHOUT_PAGE();
  const TemporaryFolder folder;
  fs::copy(finished_run(), folder.path() / "other", fs::copy_options::recursive);
  const Outcome outcome =
      call({"report", finished_run().string(), "other"}, {.folder = folder.path()});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(text_of(folder.path() / "report.html"), HasSubstr("id=\"run-1\">"));
  EXPECT_TRUE(fs::exists(folder.path() / "report.tex"));
}

// As after a run on a bag, which has no ground truth beside it.
TEST(ReportProgram, TheTruthMayBeNamed) {
  SKIP_WITHOUT_PAGE();
  const TemporaryFolder folder;
  const fs::path run = folder.path() / "run", truth = recording_with_people();
  fs::copy(finished_run(), run, fs::copy_options::recursive);
  std::string yaml = text_of(run / "pipeline.yaml");
  const std::string path = "path: " + truth.string();
  ASSERT_NE(yaml.find(path), std::string::npos) << yaml;
  folder.write("run/pipeline.yaml", yaml.replace(yaml.find(path), path.size(), "path: room.bag"));
  EXPECT_FALSE(report::read_run(run, "name").evaluation);
  EXPECT_TRUE(report::read_run(run, "name", {.truth = truth / "groundtruth.txt"}).evaluation);

  Outcome outcome = call({"report", run.string(), "--reference", truth.string()});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, Not(HasSubstr("no errors")));
  EXPECT_THAT(text_of(run / "report.csv"), HasSubstr("ATE"));

  outcome = call({"report", run.string(), "--reference", "nowhere.txt"});
  EXPECT_NE(outcome.exit_code, 0);
  EXPECT_THAT(outcome.err, HasSubstr("nowhere.txt"));
}

TEST(ReportProgram, DamagedRunsAreShownAsFarAsTheyGo) {
  SKIP_WITHOUT_PAGE();
  const TemporaryFolder folder;
  const fs::path run = folder.path() / "run";
  fs::copy(finished_run(), run, fs::copy_options::recursive);
  folder.write("run/summary.json", "{\"frames\": 12");
  folder.write("run/frames.csv",
               "frame,time,state,features,matches,inliers,moving_points,"
               "excluded_percent\n0,1.0,trac");
  folder.write("run/trajectory.txt", "1000.0 0 0 0 0 0\n");
  folder.write("run/map/map.ot", "# Octomap OcTree file\n");
  for (const auto& picture : fs::directory_iterator(run / "images"))
    std::ofstream(picture.path()) << "no picture";
  fs::remove(run / "images/000000.jpg");
  ASSERT_EQ(::mkfifo((run / "images/000000.jpg").c_str(), 0600), 0);
  const Outcome outcome = call({"report", run.string()});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("note: summary.json cannot be read"),
                                 HasSubstr("frames.csv:2: "), HasSubstr("trajectory.txt:1: ")));
  EXPECT_TRUE(fs::exists(run / "report.html"));
  EXPECT_EQ(text_of(run / "trajectory.txt"), "1000.0 0 0 0 0 0\n");
}

TEST(RunReader, ASummaryWithValuesOfOtherTypesIsANote) {
  const TemporaryFolder folder;
  folder.write("summary.json", R"({"complete": "maybe", "coverage": "all"})");
  EXPECT_THAT(report::read_run(folder.path(), "name").notes,
              ::testing::Contains(HasSubstr("type must be boolean")));
}

TEST(ReportProgram, TheRecordingsOfAStudyHaveTheirOwnTruth) {
  const TemporaryFolder folder;
  folder.write("study.yaml",
               "version: 1\nsequences: [{name: a, dataset: a}]\n"
               "variants: [{name: v, pipeline: orb_baseline}]\n");
  const Outcome outcome = call({"report", folder.path().string(), "--reference", "truth.txt"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("leave out --reference"));
}

TEST(ReportProgram, OnAFullDiskTheEarlierReportStays) {
  SKIP_WITHOUT_PAGE();
  const TemporaryFolder folder;
  folder.write("page.html", "of yesterday");
  const std::string tables = "% Needs \\usepackage{booktabs}.\n% of yesterday\n";
  folder.write("page.tex", tables);
  const std::string run = finished_run().string();  // made while there is room
  {
    const FullDisk full(65536);  // bytes
    const Outcome outcome = call({"report", run, "-o", "page.html"}, {.folder = folder.path()});
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("page.html: cannot write: "));
  }
  EXPECT_EQ(text_of(folder.path() / "page.html"), "of yesterday");
  EXPECT_EQ(text_of(folder.path() / "page.tex"), tables);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 2);
}

// Such as the results.csv of a study and the frames.csv of a run.
TEST(ReportProgram, FilesBesideThePageThatAreNoTablesOfAReportStay) {
  SKIP_WITHOUT_PAGE();
  const TemporaryFolder folder;
  for (const char* ending : {".csv", ".tex"}) {
    const fs::path file = folder.write(std::string("results") + ending, "of the study");
    const Outcome outcome =
        call({"report", finished_run().string(), "-o", "results.html"}, {.folder = folder.path()});
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("is no table of an earlier report, and would be replaced"));
    EXPECT_EQ(text_of(file), "of the study");
    fs::remove(file);
  }
  for (int time = 0; time < 2; ++time)
    EXPECT_EQ(
        call({"report", finished_run().string(), "-o", "results.html"}, {.folder = folder.path()})
            .exit_code,
        0);
}

TEST(ReportProgram, WhatIsNoRunIsNamed) {
  const TemporaryFolder folder;
  Outcome outcome = call({"report", folder.path().string()});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("holds neither a run nor a study"));
  EXPECT_EQ(call({"report", (folder.path() / "none").string()}).exit_code, 2);
  outcome = call({"report", folder.path().string(), "-o", "page.tex"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("page.tex: a page is an .html file"));
  EXPECT_TRUE(fs::is_empty(folder.path()));
  folder.write("study.yaml", "version: 1\nsequences: []\nvariants: []\nspeed: 3\n");
  outcome = call({"report", folder.path().string()});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("study.yaml:4:1: error: study: unknown key 'speed'"));
  outcome = call({"report", folder.path().string(), folder.path().string()});
  EXPECT_THAT(outcome.err, HasSubstr("a report is of one study, or of runs"));
}

/// Two sequences and two variants; one run is not finished, one has another version's result, and
/// one has failed.
void write_study(const TemporaryFolder& folder) {
  folder.write(
      "study.yaml",
      "version: 1\nsequences:\n  - {name: walking, dataset: /none/walking}\n"
      "  - {name: sitting, dataset: /none/sitting}\nvariants:\n"
      "  - {name: plain, pipeline: orb_baseline}\n  - {name: better, pipeline: stillpoint}\n"
      "baseline: plain\n");
  for (const char* cell :
       {"walking/plain/0", "walking/better/0", "sitting/plain/0", "sitting/better/0"}) {
    const fs::path run = folder.path() / "runs" / cell;
    fs::create_directories(run);
    study::CellResult result{
        .fingerprint = "f",
        .program = "p",
        .origin = {"1.2.3", "0123456789ab", "a machine, 2 cores", "2026-01-30"}};
    result.values[study::kAte] = std::string(cell).find("plain") == std::string::npos ? 0.02 : 0.1;
    result.values[study::kCoverage] = 100.0;
    study::write_result(run, result);
  }
  fs::remove(folder.path() / "runs/sitting/plain/0/result.json");
  folder.write("runs/walking/better/0/result.json", "{\"format\": 99}");
  study::CellResult failed{.origin = {"1.2.3", "", "another machine", "2026-02-01"},
                           .exit_code = 139,
                           .message = "ended by signal 11"};
  study::write_result(folder.path() / "runs/sitting/better/0", failed);
}

TEST(ReportProgram, AnIncompleteStudySaysSo) {
  SKIP_WITHOUT_PAGE();
  const TemporaryFolder folder;
  write_study(folder);
  const Outcome outcome = call({"report", folder.path().string()});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(
      outcome.err,
      AllOf(HasSubstr("note: Not finished: 2 of 4 runs have no result"),
            HasSubstr("sitting/plain/0: Not finished"),
            HasSubstr("walking/better/0: result.json cannot be read: damaged, or written by "
                      "another version"),
            HasSubstr("sitting/better/0: Failed with exit code 139: ended by signal 11")));
  EXPECT_EQ(text_of(folder.path() / "runs/walking/better/0/result.json"), "{\"format\": 99}");
  const std::string csv = text_of(folder.path() / "report.csv");
  EXPECT_THAT(csv, HasSubstr("walking,plain,0.1,0.1000,0,"));
}

TEST(StudyReader, WhatRunsHaveInCommonIsSaidOnceAndWhereTheErrorsAreWithoutTheRecording) {
  const TemporaryFolder folder;
  study::Study study;
  study.repeats = 3;
  study.sequences.resize(1);
  study.sequences[0].name = "walking";
  study.sequences[0].dataset = "/none/walking";
  study.variants.resize(1);
  study.variants[0].name = "plain";
  for (int repeat = 0; repeat < study.repeats; ++repeat) {
    const std::string run = "runs/walking/plain/" + std::to_string(repeat);
    folder.write(run + "/trajectory.txt", "1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n");
    study::CellResult result;
    result.values[study::kAte] = 0.1;
    study::write_result(folder.path() / run, result);
  }
  const report::ReportData data = report::read_study(folder.path(), study);
  EXPECT_THAT(data.notes, ::testing::ElementsAre(
                              HasSubstr("walking/plain/0 and 2 more: summary.json is missing")));
  EXPECT_THAT(data.runs[2].notes,
              ::testing::IsSupersetOf({HasSubstr("The recording is not at /none/walking"),
                                       HasSubstr("The tables of the study have the errors")}));
}

}  // namespace
}  // namespace stillpoint::testing
