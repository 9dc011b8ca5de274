// `stillpoint report` as a user calls it, and its page in a browser.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <nlohmann/json.hpp>

#include "report/page_json.hpp"
#include "report/report_reader.hpp"
#include "report/run_reader.hpp"
#include "study/cell_result.hpp"
#include "support/browser.hpp"
#include "support/full_disk.hpp"
#include "support/program.hpp"
#include "support/simulated_recording.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A run with pictures and a dense map, made once for all tests of the process.
const fs::path& finished_run() {
  static const TemporaryFolder folder;
  static const fs::path run = [] {
    const fs::path path = folder.path() / "a run";
    const Outcome outcome =
        call({"run", "stillpoint", "--dataset", recording_with_people().string(), "-o",
              path.string(), "--quiet", "--images", "--with", "web.port=0", "--with",
              "web.record=live.html", "--set", "runtime.mode=inline"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return path;
  }();
  return run;
}

bool page_is_built() {
  return fs::exists(fs::path(STILLPOINT_BINARY_DIR) / "share/stillpoint/report.html");
}

#define SKIP_WITHOUT_PAGE() \
  if (!page_is_built()) GTEST_SKIP() << "built without the page: npm or esbuild are missing"

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
  EXPECT_THAT(text_of(folder.path() / "new/page.tex"), HasSubstr("\\toprule"));
  EXPECT_THAT(text_of(folder.path() / "new/page.csv"), HasSubstr("Runs,a run,ATE RMSE (m),0.0"));
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
  const std::string option = "  interval: 3";
  yaml.replace(yaml.find(option), option.size(), "  interval: 5");
  folder.write("other/pipeline.yaml", yaml);
  const report::ReportData data = report::read_runs({finished_run(), other});
  ASSERT_EQ(data.runs.size(), 2u);
  EXPECT_THAT(data.runs[0].changes, IsEmpty());
  ASSERT_EQ(data.runs[1].changes.size(), 1u);
  EXPECT_EQ(data.runs[1].changes[0].key, "segmentation.interval");
  EXPECT_EQ(data.runs[1].changes[0].base, "3");
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

constexpr int kRooms = 8;

/// On each of the sequences room_0, room_1, … `better` has a fifth of the error of `plain`.
void write_finished_study(const TemporaryFolder& folder) {
  std::string sequences;
  for (int room = 0; room < kRooms; ++room) {
    const std::string name = "room_" + std::to_string(room);
    sequences += "  - {name: " + name + ", dataset: /none/" + name + "}\n";
    for (const auto& [variant, error] : {std::pair{"plain", 0.1}, {"better", 0.02}}) {
      study::CellResult result{
          .fingerprint = "f",
          .program = "p",
          .origin = {"1.2.3", "0123456789ab", "a machine, 2 cores", "2026-01-30"}};
      result.values[study::kAte] = error + 0.001 * room;
      result.values[study::kCoverage] = 100.0;
      const fs::path run = folder.path() / "runs" / name / variant / "0";
      fs::create_directories(run);
      study::write_result(run, result);
    }
  }
  folder.write("study.yaml", "version: 1\nquestion: Is it better?\nsequences:\n" + sequences +
                                 "variants:\n  - {name: plain, pipeline: orb_baseline}\n"
                                 "  - {name: better, pipeline: stillpoint}\nbaseline: plain\n");
}

/// What probe.js has seen in the page.
nlohmann::json probed(const fs::path& page, const TemporaryFolder& folder) {
  std::string text = text_of(page);
  const std::string script =
      "<script>" + text_of(fs::path(STILLPOINT_SOURCE_DIR) / "tests/report/probe.js") + "</script>";
  text.insert(text.rfind("</body>"), script);
  const fs::path probe = folder.write("probe.html", text);
  const std::string result =
      document_in_browser("file://" + probe.string(), "document.getElementById('probe') !== null");
  const std::string begin = "<pre id=\"probe\">";
  const std::size_t from = result.find(begin);
  if (from == std::string::npos) return {{"ready", "never"}};
  const std::size_t to = result.find("</pre>", from);
  return nlohmann::json::parse(result.substr(from + begin.size(), to - from - begin.size()));
}

TEST(ReportPage, DrawsSortsAndTurnsInABrowser) {
  SKIP_WITHOUT_PAGE();
  SKIP_WITHOUT_BROWSER();
  const TemporaryFolder folder;
  const fs::path page = folder.path() / "report.html";
  const Outcome outcome = call({"report", finished_run().string(), "-o", page.string()});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json seen = probed(page, folder);
  ASSERT_EQ(seen["ready"], "yes") << seen;
  EXPECT_EQ(seen["errors"], nlohmann::json::array());
  EXPECT_EQ(seen["charts"], 5);  // ATE, RPE, excluded pixels, features, stages
  EXPECT_GT(seen["lines"], 4);
  EXPECT_GT(seen["pictures"], 1);
  const auto rising = seen["rising"].get<std::vector<double>>();
  EXPECT_TRUE(std::ranges::is_sorted(rising));
  EXPECT_EQ(std::vector<double>(rising.rbegin(), rising.rend()),
            seen["falling"].get<std::vector<double>>());
  EXPECT_EQ(seen["turned"], true);
  EXPECT_EQ(seen["repainted"], true);
  EXPECT_EQ(seen["replayed"], true);
}

TEST(ReportPage, ShowsAStudyAndOpensItsRunsInABrowser) {
  SKIP_WITHOUT_PAGE();
  SKIP_WITHOUT_BROWSER();
  const TemporaryFolder folder;
  write_finished_study(folder);
  const Outcome outcome = call({"report", folder.path().string()});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::string shown =
      document_in_browser("file://" + (folder.path() / "report.html").string(), R"((() => {
        if (document.documentElement.dataset.ready !== 'yes') return false;
        const wanted = 'room_3/better/0';
        const names = [...document.querySelectorAll('tbody th a')];
        names.find(name => name.textContent === wanted).click();
        return document.getElementById('run').selectedOptions[0].textContent === wanted;
      })())");
  EXPECT_THAT(shown, AllOf(HasSubstr("Is it better?"), HasSubstr("commit 0123456789ab"),
                           HasSubstr("Compared with plain"), HasSubstr("0.0078")));
  const auto count = [&](const std::string& text) {
    int found = 0;
    for (std::size_t at = 0; (at = shown.find(text, at)) != std::string::npos; ++at) ++found;
    return found;
  };
  EXPECT_EQ(count("<td class=\"best\">0.02"), kRooms);
  EXPECT_GT(count("significant"), 0);
}

}  // namespace
}  // namespace stillpoint::testing
