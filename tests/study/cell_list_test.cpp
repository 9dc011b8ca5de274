// Cells for other machines.
#include "study/cell_list.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stillpoint/error.hpp"
#include "study/slurm_batch.hpp"
#include "study/slurm_queue.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint::study {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

ListedCell listed_cell(const std::string& variant) {
  return {.cell = {.cell = {},
                   .command = {"/bin/echo", "a \"b\" 'c'\n", "ü"},
                   .run = "/out/runs/s/" + variant + "/0",
                   .recording = "/recordings/s",
                   .fingerprint = "0123",
                   .time_limit = 1.5},
          .program = "build"};
}

TEST(CellList, GivesBackWhatWasWritten) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "new/cells.jsonl";
  write_cells(file, {listed_cell("a"), listed_cell("b")});
  const ListedCell cell = read_cell(file, 1);
  EXPECT_THAT(cell.cell.command, ElementsAre("/bin/echo", "a \"b\" 'c'\n", "ü"));
  EXPECT_EQ(cell.cell.run, "/out/runs/s/b/0");
  EXPECT_EQ(cell.cell.recording, "/recordings/s");
  EXPECT_EQ(cell.cell.fingerprint, "0123");
  EXPECT_EQ(cell.cell.time_limit, 1.5);
  EXPECT_EQ(cell.program, "build");
  EXPECT_EQ(read_cells(file).size(), 2u);
}

TEST(CellList, SaysWhatIsWrong) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "cells.jsonl";
  EXPECT_THAT([&] { read_cell(file, 0); },
              ThrowsMessage<Error>(HasSubstr("must be the same on every machine")));
  write_cells(file, {listed_cell("a")});
  EXPECT_THAT([&] { read_cell(file, 1); }, ThrowsMessage<Error>(HasSubstr("has no cell 1")));
  folder.write("cells.jsonl", "{\"command\": [");
  EXPECT_THAT([&] { read_cells(file); },
              ThrowsMessage<Error>(HasSubstr("cells.jsonl: is no list of cells")));
}

TEST(SlurmBatch, IsKnownByWhatSbatchAnswered) {
  const testing::TemporaryFolder folder;
  folder.write("10/sbatch.txt", "12\n");
  folder.write("9/sbatch.txt", "sbatch: warning: deprecated\n11;cluster\n");
  folder.write("8/sbatch.txt", "sbatch: error: Batch job submission failed: no such 7\n");
  folder.write("notes/sbatch.txt", "13\n");
  std::vector<std::string> jobs;
  for (const SlurmBatch& batch : submitted_batches(folder.path())) jobs.push_back(batch.job);
  EXPECT_THAT(jobs, ElementsAre("11", "12"));
  EXPECT_TRUE(submitted_batches(folder.path() / "none").empty());
}

TEST(SlurmState, ThatIsNotOverMayGoOn) {
  for (const char* name : {"PENDING", "RUNNING", "COMPLETING", "SUSPENDED", "REQUEUED"})
    EXPECT_FALSE((SlurmState{.name = name, .reason = {}}.is_over())) << name;
  for (const char* name : {"COMPLETED", "CANCELLED", "TIMEOUT", "NODE_FAIL", "OUT_OF_MEMORY"})
    EXPECT_TRUE((SlurmState{.name = name, .reason = {}}.is_over())) << name;
}

}  // namespace
}  // namespace stillpoint::study
