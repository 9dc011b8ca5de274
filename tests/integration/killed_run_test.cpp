// A run that is killed, while somebody watches it and it writes whatever it can.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "output_web/test_viewer.hpp"
#include "support/program.hpp"
#include "support/simulated_recording.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::UnorderedElementsAre;

std::vector<fs::path> files_below(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) files.push_back(entry.path());
  return files;
}

bool is_part(const fs::path& file) { return file.extension() == ".part"; }

// Whatever has the name of a result is whole, but for bag and page, which grow and are read as far
// as they go.
void expect_whole(const fs::path& file) {
  if (file.extension() == ".jpg")
    EXPECT_EQ(cv::imread(file.string()).size(), cv::Size(640, 480)) << file;
  else if (file.filename() == "run.mcap")
    EXPECT_EQ(call({"inspect", file.string()}).exit_code, 0);
  else
    EXPECT_THAT((std::vector<std::string>{"live.html", "log.txt", "pipeline.yaml"}),
                ::testing::Contains(file.filename()));
}

class KilledRun : public ::testing::TestWithParam<const char*> {};

TEST_P(KilledRun, LeavesNoTornFileAndTheNextOneItsOwnOnly) {
  const TemporaryFolder folder;
  const fs::path out = folder.path() / "out";
  const std::vector<std::string> arguments = {
      "run", "orb_baseline", "--dataset", simulated_recording().string(), "-o", out.string()};
  std::vector<std::string> watched = arguments;
  for (const char* more : {"--with", "mcap", "--with", "images.every=1", "--view=0", "--with",
                           "web.record=live.html", "--set", "runtime.pace=sensor", "--save-map"})
    watched.emplace_back(more);
  watched.push_back((out / "sparse.map").string());
  Program program(watched);
  const std::string told = program.wait_for_line("live view at ");
  ASSERT_FALSE(told.empty());
  output_web::TestViewer viewer(output_web::port_of(told));
  ASSERT_TRUE(viewer.asked());
  ASSERT_TRUE(program.wait_for(GetParam()));
  program.send(SIGKILL);
  EXPECT_EQ(program.finish().signal, SIGKILL);
  const std::vector<fs::path> left = files_below(out);
  for (const fs::path& file : left)
    if (!is_part(file)) expect_whole(file);

  const Outcome next = call(arguments);
  EXPECT_EQ(next.exit_code, 0) << next.err;
  EXPECT_EQ(count_poses(out / "trajectory.txt"), static_cast<std::size_t>(kSimulatedFrames));
  std::vector<std::string> names;
  for (const fs::path& file : files_below(out)) names.push_back(file.filename());
  EXPECT_THAT(names, UnorderedElementsAre("frames.csv", "keyframes.txt", "log.txt", "pipeline.yaml",
                                          "summary.json", "timings.csv", "trajectory.txt"));
}

INSTANTIATE_TEST_SUITE_P(Moments, KilledRun,
                         ::testing::Values("live view at ", " key frames  tracking"),
                         [](const auto& moment) {
                           return moment.index == 0 ? "BeforeTheFirstFrame" : "InTheMiddle";
                         });

}  // namespace
}  // namespace stillpoint::testing
