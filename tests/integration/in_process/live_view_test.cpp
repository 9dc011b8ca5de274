// Who looks at a run does not change it.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "output_web/test_viewer.hpp"
#include "stillpoint/engine/engine.hpp"
#include "stillpoint/testing/test_recording.hpp"
#include "support/build_folder.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;
using output_web::Record;
using output_web::TestViewer;

const TestRecording& watched_recording() {
  static const TestRecording kRecording({.frames = 30, .person = false});
  return kRecording;
}

/// A run of one's own frames; `url` gets the address that the live view has told.
std::unique_ptr<Engine> engine_for(const std::string& mode, const std::vector<std::string>& outputs,
                                   const fs::path& folder, std::string& url) {
  ::setenv("STILLPOINT_CONFIG_PATH", STILLPOINT_SOURCE_DIR "/configs", 1);
  EngineSetup setup{.request = {.pipeline = "orb_baseline",
                                .assignments = {"runtime.mode=" + mode},
                                .outputs = outputs,
                                .pushed = true,
                                .plugin_folders = {build_folder() / "lib/stillpoint/plugins"}},
                    .output_directory = folder};
  setup.log = [&url](LogLevel, std::string_view text) {
    const std::size_t place = text.find("http://");
    if (place != std::string_view::npos) url = text.substr(place);
  };
  return std::make_unique<Engine>(std::move(setup));
}

struct WatchedRun {
  std::vector<TrackedPose> poses;
  std::size_t frames_seen = 0, keyframes_seen = 0;
};

WatchedRun run(const std::string& mode, bool watched) {
  const TemporaryFolder folder;
  std::string url;
  const auto outputs =
      watched ? std::vector<std::string>{"web.port=0"} : std::vector<std::string>{};
  const auto engine = engine_for(mode, outputs, folder.path(), url);
  std::unique_ptr<TestViewer> viewer, hanging;
  if (watched) {
    viewer = std::make_unique<TestViewer>(output_web::port_of(url));
    hanging = std::make_unique<TestViewer>(output_web::port_of(url));
    hanging->ask();  // and does not read
  }
  WatchedRun result;
  for (std::size_t i = 0; i < watched_recording().size(); ++i) {
    engine->process(*watched_recording().frame(i));
    if (!watched) continue;
    auto records = viewer->asked();
    if (!records) throw std::runtime_error("the viewer was sent away");
    result.frames_seen += (*records)[Record::kFrames].size();
    for (const std::string& keyframes : (*records)[Record::kKeyFrames])
      result.keyframes_seen += output_web::number_at<std::uint32_t>(keyframes, 0);
  }
  engine->finish();
  result.poses = engine->poses();
  return result;
}

TEST(LiveView, LeavesPosesAsTheyAreInline) {
  const WatchedRun alone = run("inline", false), watched = run("inline", true);
  EXPECT_EQ(watched.frames_seen, watched_recording().size());
  EXPECT_GT(watched.keyframes_seen, 0u);
  ASSERT_EQ(alone.poses.size(), watched.poses.size());
  for (std::size_t i = 0; i < alone.poses.size(); ++i) {
    ASSERT_EQ(alone.poses[i].state, TrackState::kTracking);
    EXPECT_EQ(alone.poses[i].world_from_camera.matrix(),
              watched.poses[i].world_from_camera.matrix())
        << i;
  }
}

TEST(LiveView, ShowsARunWithThreads) {
  const WatchedRun watched = run("threaded", true);
  EXPECT_GT(watched.frames_seen, 0u);
  EXPECT_GT(watched.keyframes_seen, 0u);
  for (const TrackedPose& pose : watched.poses) EXPECT_EQ(pose.state, TrackState::kTracking);
}

}  // namespace
}  // namespace stillpoint::testing
