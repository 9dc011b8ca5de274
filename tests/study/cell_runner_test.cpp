// Cells whose program is a shell.
#include "study/cell_runner.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/stat.h>

#include <cmath>
#include <csignal>
#include <fstream>
#include <stdexcept>
#include <thread>

#include "fixtures.hpp"
#include "study/cell_folder.hpp"
#include "study/child_process.hpp"
#include "study/text_file.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint::study {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr const char* kSummary =
    R"({"coverage": 0.5, "times_lost": 1, "dropped_frames": 0, "processed_frames": 60, )"
    R"("wall_seconds": 1.5, "cpu_ms_per_frame": 20,)"
    R"( "peak_memory_mib": 80, "stages": {"track_thread": {"wall_ms": {"mean": 10.5}, "cpu_ms": {"p50": 9, "p95": 12}}, )"
    R"("output preview": {"wall_ms": {"mean": 1}}}})";

class CellRunner : public ::testing::Test {
 protected:
  CellRunner() {
    std::string truth;
    for (int i = 0; i < 60; ++i)
      truth += std::to_string(1 + 0.1 * i) + " " + std::to_string(0.01 * i * i) + " " +
               std::to_string(0.05 * i) + " 0 0 0 0 1\n";
    folder_.write("recording/groundtruth.txt", truth);
    folder_.write("summary.json", kSummary);
  }

  fs::path path(const std::string& name) const { return folder_.path() / name; }

  /// Writes what a good run does: a summary, and the truth as its trajectory.
  std::string good_run(const fs::path& run) const {
    return "cp '" + path("summary.json").string() + "' '" + run.string() + "' && cp '" +
           path("recording/groundtruth.txt").string() + "' '" + run.string() + "/trajectory.txt'";
  }

  PlannedCell cell(int repeat, const std::string& script, const std::string& print = "f") const {
    const fs::path run = path("runs/" + std::to_string(repeat));
    return {.cell = {0, 0, repeat},
            .command = {"/bin/sh", "-c", script.empty() ? good_run(run) : script},
            .run = run,
            .recording = path("recording"),
            .fingerprint = print};
  }

  /// The repeats that were run, in the order in which they ended.
  std::vector<int> run(const std::vector<PlannedCell>& cells, int jobs = 1,
                       const std::stop_token& stop = {}) {
    std::vector<int> ran;
    results_.assign(cells.size(), std::nullopt);
    for (std::size_t i = 0; i < cells.size(); ++i) results_[i] = valid_result(cells[i]);
    run_missing(
        cells, {.fingerprint = "build", .version = "1.2.3", .commit = "0123456789ab"}, jobs, stop,
        [&](const Cell& finished, const CellResult&, const StudyProgress& progress) {
          ran.push_back(finished.repeat);
          EXPECT_EQ(progress.done, ran.size());
        },
        results_);
    return ran;
  }

  testing::TemporaryFolder folder_;
  std::vector<std::optional<CellResult>> results_;
};

TEST_F(CellRunner, MeasuresARun) {
  EXPECT_THAT(run({cell(0, "")}), ElementsAre(0));
  ASSERT_TRUE(results_[0]);
  const CellResult& result = *results_[0];
  EXPECT_FALSE(result.failed()) << result.message;
  EXPECT_NEAR(*result.values[kAte], 0.0, 1e-9);
  EXPECT_NEAR(*result.values[kScale], 1.0, 1e-9);
  EXPECT_NEAR(*result.values[kRpeTranslation], 0.0, 1e-9);
  EXPECT_EQ(result.values[kCoverage], 50.0);
  EXPECT_EQ(result.values[kTrackP95], 12.0);
  EXPECT_EQ(result.values[kSpeed], 40.0);
  EXPECT_EQ(result.program, "build");
}

MetricId metric_of(const std::string& key) {
  for (std::size_t i = 0; i < kMetricCount; ++i)
    if (metrics()[i].key == key) return static_cast<MetricId>(i);
  throw std::out_of_range(key);
}

TEST_F(CellRunner, MeasuresTheTimeOfEachStage) {
  run({cell(0, "")});
  const MetricValues& values = results_[0]->values;
  EXPECT_EQ(values[metric_of("track_thread_ms")], 10.5);
  EXPECT_FALSE(values[metric_of("segmentation_ms")]);
  EXPECT_STREQ(metrics()[kMetricCount - 1].key, "dense_ms");
}

// A square of 2 x 2 m in 400 poses; after alignment, every tenth one lies 0.1 m off its place,
// alternately above and below.
TEST_F(CellRunner, MeasuresMeanMedianAndStandardDeviationOfTheErrors) {
  std::string truth, estimate;
  for (int i = 0; i < 400; ++i) {
    const int side = i / 100, along = i % 100;
    const double way = 0.02 * along;
    const double x[] = {way, 2, 2 - way, 0}, y[] = {0, way, 2, 2 - way};
    const double off = i % 10 == 5 ? (i % 20 == 5 ? 0.1 : -0.1) : 0.0;
    const auto pose = [&](double z) {
      return std::to_string(1 + 0.1 * i) + " " + std::to_string(x[side]) + " " +
             std::to_string(y[side]) + " " + std::to_string(z) + " 0 0 0 1\n";
    };
    truth += pose(0);
    estimate += pose(off);
  }
  folder_.write("recording/groundtruth.txt", truth);
  const std::string file = folder_.write("estimate.txt", estimate).string();
  run({cell(0, "cp '" + path("summary.json").string() + "' '" + path("runs/0").string() +
                   "' && cp '" + file + "' '" + path("runs/0/trajectory.txt").string() + "'")});
  const MetricValues& values = results_[0]->values;
  ASSERT_TRUE(values[kAteMean]) << results_[0]->message;
  // Aligning turns the estimate by less than a milliradian.
  EXPECT_NEAR(*values[kAte], 0.1 * std::sqrt(0.1), 1e-3);
  EXPECT_NEAR(*values[kAteMean], 0.01, 1e-3);
  EXPECT_NEAR(*values[kAteMedian], 0.0, 1e-3);
  EXPECT_NEAR(*values[kAteSd], 0.03, 1e-3);
  // Over 1 s, every tenth motion is wrong by 0.2 m: from one displaced pose to the next.
  EXPECT_NEAR(*values[kRpeTranslationMean], 0.02, 1e-3);
  EXPECT_NEAR(*values[kRpeTranslationMedian], 0.0, 1e-9);
  EXPECT_NEAR(*values[kRpeTranslationSd], 0.06, 1e-3);
  EXPECT_NEAR(*values[kRpeRotationMean], 0.0, 1e-9);
}

TEST_F(CellRunner, KeepsWhereAndWhenARunWasMade) {
  run({cell(0, "")});
  const auto kept = read_result(path("runs/0"));
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->origin.version, "1.2.3");
  EXPECT_EQ(kept->origin.commit, "0123456789ab");
  EXPECT_THAT(kept->origin.machine, ::testing::ContainsRegex("[1-9][0-9]* cores?$"));
  EXPECT_THAT(kept->origin.date, ::testing::MatchesRegex("20..-[01].-[0-3]."));
}

TEST_F(CellRunner, ARunThatTakesTooLongHasFailed) {
  PlannedCell slow = cell(0, "exec sleep 1000");
  slow.time_limit = 0.2;
  run({slow, cell(1, "")});
  EXPECT_EQ(results_[0]->exit_code, 124);
  EXPECT_EQ(results_[0]->message, "took longer than the time limit of 0.2 s");
  EXPECT_LT(results_[0]->seconds, 900.0);
  EXPECT_FALSE(results_[1]->failed());
}

TEST_F(CellRunner, RunsOnlyWhatIsMissing) {
  const std::vector<PlannedCell> cells = {cell(0, ""), cell(1, ""), cell(2, "")};
  EXPECT_THAT(run(cells), ElementsAre(0, 1, 2));
  EXPECT_THAT(run(cells), ElementsAre());
  EXPECT_EQ(results_[1]->values[kPeakMemory], 80.0);
  fs::remove_all(cells[1].run);
  EXPECT_THAT(run(cells), ElementsAre(1));
}

TEST_F(CellRunner, AFolderOfTheUserStaysAndNothingRuns) {
  const std::vector<PlannedCell> cells = {cell(0, ""), cell(1, "")};
  folder_.write("runs/1/notes.txt", "mine");
  EXPECT_THROW(run(cells), Error);
  EXPECT_TRUE(fs::exists(cells[1].run / "notes.txt"));
  EXPECT_FALSE(fs::exists(cells[0].run));
}

TEST_F(CellRunner, ARunThatIsMadeAgainReplacesItsOwnFilesOnly) {
  const fs::path folder = path("runs/0");
  run({cell(0, good_run(folder) + " && mkdir '" + (folder / "images").string() + "' '" +
                   (folder / "map").string() + "' && echo x > '" +
                   (folder / "images/000000.jpg").string() + "' && echo x > '" +
                   (folder / "map/map.ot").string() + "'")});
  ASSERT_FALSE(results_[0]->failed()) << results_[0]->message;
  folder_.write("runs/0/notes.txt", "mine");
  folder_.write("runs/0/images/mine.jpg", "mine");
  folder_.write("runs/0/trajectory.txt", "edited");
  run({cell(0, "echo 'error: no network' >&2; exit 2", "changed")});
  EXPECT_EQ(results_[0]->message, "no network");
  EXPECT_EQ(read_text(folder / "notes.txt"), "mine");
  EXPECT_EQ(read_text(folder / "images/mine.jpg"), "mine");
  EXPECT_EQ(read_text(folder / "trajectory.txt"), "edited");
  for (const char* own : {"summary.json", "images/000000.jpg", "map"})
    EXPECT_FALSE(fs::exists(folder / own)) << own;
  run({cell(0, "", "again")});
  EXPECT_FALSE(results_[0]->failed()) << results_[0]->message;
  EXPECT_EQ(read_text(folder / "notes.txt"), "mine");
}

TEST_F(CellRunner, WhatTheUserPutsThereStaysAlsoWhereARunIsStopped) {
  run({cell(0, "")});
  folder_.write("runs/0/notes.txt", "mine");
  const fs::path started = path("started");
  ASSERT_EQ(mkfifo(started.c_str(), 0600), 0);
  std::stop_source stop;
  std::jthread user([&] {
    std::ifstream(started).get();  // waits for the cell
    stop.request_stop();
  });
  run({cell(0, "echo x > '" + started.string() + "'; exec tail -f /dev/null", "changed")}, 1,
      stop.get_token());
  EXPECT_FALSE(results_[0]);
  EXPECT_THAT(run({cell(0, "", "changed")}), ElementsAre(0));
  EXPECT_EQ(read_text(path("runs/0/notes.txt")), "mine");
}

TEST_F(CellRunner, TheResultOfAJobThatNeverRanIsReplaced) {
  write_result(path("runs/0"), {.exit_code = 1, .message = "left no result"});
  folder_.write("runs/0/slurm.txt", "slurmstepd: error: no memory");
  CellFolder(path("runs/0")).forget_result();
  EXPECT_FALSE(fs::exists(path("runs/0/slurm.txt")));
  EXPECT_THAT(run({cell(0, "")}), ElementsAre(0));
}

TEST_F(CellRunner, AKilledRunLeavesNoResult) {
  const std::vector<PlannedCell> cells = {cell(0, "")};
  run(cells);
  fs::remove(cells[0].run / "result.json");
  folder_.write("runs/0/result.json.4242-0.part", "{\"fingerprint\": ");
  EXPECT_THAT(run(cells), ElementsAre(0));
  EXPECT_FALSE(fs::exists(cells[0].run / "result.json.4242-0.part"));
  folder_.write("runs/0/result.json", "{\"fingerprint\": ");
  EXPECT_THAT(run(cells), ElementsAre(0));
}

TEST_F(CellRunner, RunsAgainWhatHasChanged) {
  run({cell(0, ""), cell(1, "")});
  EXPECT_THAT(run({cell(0, "", "changed"), cell(1, "")}), ElementsAre(0));
}

TEST_F(CellRunner, AFailureIsAResultAndTriedAgain) {
  const std::vector<PlannedCell> cells = {cell(0, "echo 'error: disk is full' >&2; exit 3"),
                                          cell(1, ""), cell(2, "kill -KILL $$"), cell(3, "true")};
  EXPECT_THAT(run(cells), ElementsAre(0, 1, 2, 3));
  EXPECT_EQ(results_[0]->exit_code, 3);
  EXPECT_EQ(results_[0]->message, "disk is full");
  EXPECT_FALSE(results_[1]->failed());
  EXPECT_EQ(results_[2]->exit_code, 128 + SIGKILL);
  EXPECT_THAT(results_[2]->message, HasSubstr("Killed"));
  EXPECT_EQ(results_[3]->exit_code, 1);
  EXPECT_THAT(results_[3]->message, HasSubstr("summary.json"));
  EXPECT_THAT(run(cells), ElementsAre(0, 2, 3));
}

TEST_F(CellRunner, ARunThatNeverTrackedHasNoErrorButIsNoFailure) {
  run({cell(0, "cp '" + path("summary.json").string() + "' '" + path("runs/0").string() +
                   "'; echo '# no poses' > '" + path("runs/0/trajectory.txt").string() + "'")});
  EXPECT_FALSE(results_[0]->failed());
  EXPECT_FALSE(results_[0]->values[kAte]);
  EXPECT_EQ(results_[0]->values[kCoverage], 50.0);
  EXPECT_THAT(results_[0]->message, HasSubstr("trajectory.txt"));
}

// Each waits for the other: only together they end.
TEST_F(CellRunner, RunsSeveralAtATime) {
  const auto meet = [&](const std::string& mine, const std::string& other, int repeat) {
    return "mkfifo '" + path(mine).string() + "' 2>/dev/null; mkfifo '" + path(other).string() +
           "' 2>/dev/null; " +
           (repeat == 0
                ? "echo x > '" + path(mine).string() + "'; cat '" + path(other).string() + "'"
                : "cat '" + path(other).string() + "'; echo x > '" + path(mine).string() + "'") +
           "; " + good_run(path("runs/" + std::to_string(repeat)));
  };
  run({cell(0, meet("a", "b", 0)), cell(1, meet("b", "a", 1))}, 2);
  EXPECT_FALSE(results_[0]->failed()) << results_[0]->message;
  EXPECT_FALSE(results_[1]->failed()) << results_[1]->message;
}

TEST_F(CellRunner, AStopEndsWhatRunsAndKeepsWhatIsDone) {
  const fs::path started = path("started");
  ASSERT_EQ(mkfifo(started.c_str(), 0600), 0);
  std::stop_source stop;
  std::jthread user([&] {
    std::ifstream(started).get();  // waits for the second cell
    stop.request_stop();
  });
  const std::vector<PlannedCell> cells = {
      cell(0, ""), cell(1, "echo x > '" + started.string() + "'; exec tail -f /dev/null"),
      cell(2, "")};
  EXPECT_THAT(run(cells, 1, stop.get_token()), ElementsAre(0));
  EXPECT_TRUE(results_[0]);
  EXPECT_FALSE(results_[1]);
  EXPECT_FALSE(results_[2]);
  EXPECT_FALSE(fs::exists(cells[1].run / "result.json"));
}

TEST(ChildProcess, ThatCannotBeStartedSaysSo) {
  const testing::TemporaryFolder folder;
  EXPECT_EQ(run_process({"/no/such/program"}, folder.path() / "console", {}).exit_code, 127);
}

}  // namespace
}  // namespace stillpoint::study
