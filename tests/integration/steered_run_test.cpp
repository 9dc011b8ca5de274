// A run that somebody watches in a browser, holds, and ends: the whole program, the page as it is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "support/browser.hpp"
#include "support/program.hpp"
#include "support/simulated_recording.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

// One action after the other, each as soon as what the one before has done is to be seen.
constexpr const char* kPressButtons = R"((() => {
  const byId = (id) => document.getElementById(id);
  const frame = () => +byId('figures').querySelector('dd')?.textContent;
  const press = (id) => { byId(id).click(); return true; };
  const rests = () => {  // the frame under way when the run was paused has come, too
    if (frame() !== window.held) [window.held, window.since] = [frame(), performance.now()];
    return performance.now() - window.since > 1500;
  };
  window.actions ??= [
    () => frame() > 5 && !byId('steering').hidden && press('pause'),
    () => !byId('paused').hidden && rests() && (window.paused = frame(), press('step')),
    () => frame() > window.paused && rests() && frame() === window.paused + 1 && press('save'),
    () => byId('toast').textContent.startsWith('map saved') && press('pause'),
    () => frame() > window.held + 3 && press('end'),
    () => { document.querySelector('#end-question button[value=end]').click(); return true; },
    () => byId('connection').textContent === 'the run was stopped',
  ];
  while (window.actions.length && window.actions[0]()) window.actions.shift();
  return window.actions.length === 0;
})())";

TEST(SteeredRun, DoesWhatTheButtonsOfThePageSay) {
  if (!fs::exists(build_folder() / "share/stillpoint/report.html"))
    GTEST_SKIP() << "built without pages: npm or esbuild are missing";
  SKIP_WITHOUT_BROWSER();
  const TemporaryFolder folder;
  const fs::path out = folder.path() / "out";
  const fs::path pipeline =
      folder.write("endless.yaml",
                   "version: 1\nextends: orb_baseline\n"
                   "source: {type: simulation, people: [], balls: [], frames: 3000}\n"
                   "camera: {width: 320, height: 240, fx: 267.7, fy: 269.6, cx: 159.8, cy: 123.6, "
                   "depth_factor: 5000}\n");
  Program program({"run", pipeline.string(), "-o", out.string(), "--view=0"});
  const std::string told = program.wait_for_line("live view at ");
  const std::size_t url = told.find("http://");
  ASSERT_NE(url, std::string::npos) << told;
  document_in_browser(told.substr(url), kPressButtons);
  if (HasFailure()) program.send(SIGINT);
  const Outcome outcome = program.finish();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("stopped; what was computed until then is saved"));
  const auto summary = json_file(out / "summary.json");
  EXPECT_FALSE(summary["complete"]);
  const std::size_t poses = count_poses(out / "trajectory.txt");
  EXPECT_GT(poses, 9u);
  EXPECT_LT(poses, 3000u);
  const fs::path again = folder.path() / "again";
  const Outcome in_the_map =
      call({"run", pipeline.string(), "-o", again.string(), "--set", "source.frames=5",
            "--load-map", (out / "sparse.map").string(), "--localise-only"});
  EXPECT_EQ(in_the_map.exit_code, 0) << in_the_map.err;
  EXPECT_EQ(count_poses(again / "trajectory.txt"), 5u);
}

}  // namespace
}  // namespace stillpoint::testing
