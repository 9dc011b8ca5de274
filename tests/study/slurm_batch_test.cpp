#include "study/slurm_batch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/recording_writer.hpp"

namespace stillpoint::study {
namespace {

namespace fs = std::filesystem;

TEST(SlurmBatch, IsRemovedWithoutTheFilesOfOthers) {
  const testing::TemporaryFolder folder;
  for (const char* own : {"1/cells.jsonl", "1/job.sh", "1/sbatch.txt", "1/0.txt", "1/12.txt",
                          "2/cells.jsonl", "squeue.txt", "scontrol.txt"})
    folder.write(std::string("slurm/") + own, "");
  for (const char* other : {"1/notes.txt", "7/1.txt", "todo"})
    folder.write(std::string("slurm/") + other, "");
  remove_batches(folder.path() / "slurm");
  std::vector<std::string> left;
  for (const auto& entry : fs::recursive_directory_iterator(folder.path() / "slurm"))
    if (entry.is_regular_file())
      left.push_back(entry.path().lexically_relative(folder.path() / "slurm").string());
  EXPECT_THAT(left, ::testing::UnorderedElementsAre("1/notes.txt", "7/1.txt", "todo"));
}

TEST(SlurmBatch, NothingIsLeftWhereThereAreNone) {
  const testing::TemporaryFolder folder;
  folder.write("slurm/1/cells.jsonl", "");
  folder.write("slurm/1/0.txt", "");
  remove_batches(folder.path() / "slurm");
  EXPECT_FALSE(fs::exists(folder.path() / "slurm"));
}

}  // namespace
}  // namespace stillpoint::study
