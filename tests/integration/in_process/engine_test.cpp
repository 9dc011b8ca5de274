// Frames of one's own through a shipped pipeline: the same as `stillpoint run` makes of them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "stillpoint/engine/engine.hpp"
#include "stillpoint/engine/map_file.hpp"
#include "stillpoint/support/rectifier.hpp"
#include "support/absolute_error.hpp"
#include "support/image_io.hpp"
#include "support/simulated_recording.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;

struct ImagePair {
  double time;  // seconds
  fs::path color, depth;
};

// The simulator writes both images of a pair with one stamp.
std::vector<ImagePair> pairs_of(const fs::path& recording) {
  std::ifstream color_list(recording / "rgb.txt"), depth_list(recording / "depth.txt");
  std::vector<ImagePair> pairs;
  for (std::string color, depth; std::getline(color_list, color);) {
    std::getline(depth_list, depth);
    if (color.starts_with("#")) continue;
    const std::size_t blank = color.find(' ');
    pairs.push_back({std::stod(color), recording / color.substr(blank + 1),
                     recording / depth.substr(depth.find(' ') + 1)});
  }
  return pairs;
}

EngineSetup setup_of(const fs::path& folder, const std::string& mode,
                     const std::string& pipeline = "stillpoint") {
  // A test program lies elsewhere than an installed library.
  ::setenv("STILLPOINT_CONFIG_PATH", STILLPOINT_SOURCE_DIR "/configs", 1);
  return {.request = {.pipeline = pipeline,
                      .assignments = {"runtime.mode=" + mode},
                      .pushed = true,
                      .plugin_folders = {build_folder() / "lib/stillpoint/plugins"}},
          .output_directory = folder};
}

void push_all(Engine& engine, const fs::path& recording) {
  const Rectifier rectifier(load_camera((recording / "camera.yaml").string()));
  for (const ImagePair& pair : pairs_of(recording)) {
    const FrameReportPtr report = engine.process(
        rectifier.frame(pair.time, read_image(pair.color), read_image(pair.depth, -1)));
    ASSERT_EQ(report->result.state, TrackState::kTracking);
    ASSERT_TRUE(report->segmentation->known());
    ASSERT_EQ(report->weights->track.size(), report->frame->bgr.size());
  }
  engine.finish();
}

TEST(PushedRecording, GivesWhatRunGivesInline) {
  const fs::path& recording = recording_with_people();
  const TemporaryFolder pushed, run;
  Engine engine(setup_of(pushed.path(), "inline"));
  push_all(engine, recording);
  const Outcome outcome = call({"run", "stillpoint", "--dataset", recording.string(), "-o",
                                run.path().string(), "--set", "runtime.mode=inline"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* file : {"trajectory.txt", "keyframes.txt", "map/map.ot"}) {
    ASSERT_TRUE(fs::exists(run.path() / file)) << file;
    EXPECT_EQ(text_of(pushed.path() / file), text_of(run.path() / file)) << file;
  }
  EXPECT_GT(count_poses(run.path() / "trajectory.txt"), 0u);
}

TEST(PushedRecording, IsTrackedOnThreadsAndItsMapCanBeGoneOnWith) {
  const fs::path& recording = recording_with_people();
  constexpr int kLooks = 20;
  const TemporaryFolder folder;
  {
    Engine engine(setup_of(folder.path(), "threaded"));
    std::jthread viewer([&](const std::stop_token& stop) {
      for (int looks = 0; looks < kLooks && !stop.stop_requested();) {
        std::this_thread::yield();
        if (engine.map()->empty() || engine.dense_map().empty()) continue;
        if (looks++ == 0) engine.save_dense_map(folder.path() / "meanwhile");
      }
    });
    push_all(engine, recording);
    viewer.request_stop();
    EXPECT_GT(engine.dense_map().size(), 1000u);
    EXPECT_TRUE(engine.save_dense_map(folder.path() / "at_the_end"));
    EXPECT_EQ(text_of(folder.path() / "at_the_end/map.ot"), text_of(folder.path() / "map/map.ot"));
    EXPECT_TRUE(fs::exists(folder.path() / "meanwhile/map.ot"));
    EXPECT_EQ(engine.trajectory().size(), pairs_of(recording).size());
    save_map(*engine.map(), folder.path() / "room.map");
  }
  EXPECT_LT(absolute_error(recording, folder.path() / "trajectory.txt"), 0.01);
  EngineSetup again = setup_of({}, "threaded");  // without outputs
  again.known_map = load_map(folder.path() / "room.map");
  again.localise_only = true;
  const std::size_t keyframes = again.known_map.keyframe_count();
  Engine engine(std::move(again));
  push_all(engine, recording);
  EXPECT_EQ(engine.map()->keyframe_count(), keyframes);
}

TEST(PushedRecording, IsTrackedOnThreadsThatWaitForLabels) {
  const TemporaryFolder folder;
  Engine engine(setup_of(folder.path(), "threaded", "ds_slam"));
  push_all(engine, recording_with_people());
  EXPECT_LT(absolute_error(recording_with_people(), folder.path() / "trajectory.txt"), 0.02);
}

TEST(PushedRecording, TwoEnginesDoNotWriteIntoOneFolder) {
  const TemporaryFolder folder;
  std::optional<Engine> first(setup_of(folder.path(), "inline"));
  EXPECT_THROW(Engine(setup_of(folder.path(), "inline")), Error);
  first.reset();
  EXPECT_NO_THROW(Engine(setup_of(folder.path(), "inline")));
}

TEST(PushedRecording, AfterTheEndItsFolderIsFree) {
  const TemporaryFolder folder;
  Engine first(setup_of(folder.path(), "inline"));
  first.finish();
  const Engine second(setup_of(folder.path(), "inline"));
}

TEST(PushedRecording, WarningsGoToTheLog) {
  std::vector<std::string> warnings;
  EngineSetup setup = setup_of({}, "inline");
  setup.request.assignments.emplace_back("decision=null");
  setup.localise_only = true;
  setup.log = [&](LogLevel level, std::string_view text) {
    if (level == LogLevel::kWarning) warnings.emplace_back(text);
  };
  const Engine engine(std::move(setup));
  EXPECT_THAT(warnings,
              ::testing::ElementsAre(::testing::StartsWith("there is no decision"),
                                     ::testing::StartsWith("localise_only without a known map")));
}

TEST(PushedRecording, FaultsOfThePipelineAreToldBeforeAnythingIsMade) {
  const TemporaryFolder folder;
  EngineSetup setup = setup_of(folder.path() / "out", "treaded");
  try {
    Engine engine(std::move(setup));
    FAIL() << "no error";
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean 'threaded'"), std::string::npos)
        << error.what();
  }
  EXPECT_FALSE(fs::exists(folder.path() / "out"));
}

}  // namespace
}  // namespace stillpoint::testing
