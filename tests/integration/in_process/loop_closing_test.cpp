// The camera goes once around a room: the loop is closed, and the map stays sound.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "stillpoint/engine/engine.hpp"
#include "stillpoint/engine/make_stages.hpp"
#include "support/absolute_error.hpp"
#include "support/simulated_recording.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;

/// Looks at every version of the map that reaches the loop closer: before and after corrections.
class CheckedLoopCloser final : public LoopCloser {
 public:
  explicit CheckedLoopCloser(std::shared_ptr<LoopCloser> closer) : closer_(std::move(closer)) {}

  std::optional<MapCorrection> close(const SparseMap& map, KeyFrameId latest,
                                     std::stop_token stop) override {
    check(map);
    auto correction = closer_->close(map, latest, std::move(stop));
    loops_ += correction.has_value();
    return correction;
  }
  std::optional<MapCorrection> adjust(const SparseMap& map, std::stop_token end_early) override {
    check(map);
    auto correction = closer_->adjust(map, std::move(end_early));
    adjustments_ += correction.has_value();
    return correction;
  }

  int loops() const { return loops_; }
  int adjustments() const { return adjustments_; }

 private:
  static void check(const SparseMap& map) { EXPECT_EQ(map.check(), std::nullopt); }

  std::shared_ptr<LoopCloser> closer_;
  int loops_ = 0;
  int adjustments_ = 0;
};

// Three times as fast as in room_loop, and small images: a sanitizer takes its time.
fs::path once_around() {
  return recording_of("room_loop_empty", 460, with_small_images({"source.motion.speed=2.6"}));
}

class LoopClosing : public ::testing::TestWithParam<const char*> {
 protected:
  /// Metres. Threaded, frames come eight times as fast as in reality, and how many of them become
  /// key frames depends on what else the machine does: mostly below 0.05, seldom more.
  static double most_error() { return std::string(GetParam()) == "inline" ? 0.02 : 0.10; }
};

TEST_P(LoopClosing, ClosesTheLoopAndLeavesASoundMap) {
  const TemporaryFolder folder;
  const fs::path configs = fs::path(STILLPOINT_SOURCE_DIR) / "configs";
  const fs::path file = folder.write(
      "loop.yaml", "version: 1\nextends: " + (configs / "pipelines/orb_baseline.yaml").string() +
                       "\nloop_closer: {type: orb}\n");
  const fs::path recording = once_around();
  Registry registry;
  const PipelineConfig config =
      load_pipeline({.pipeline = file.string(),
                     .dataset = recording,
                     .camera = (recording / "camera.yaml").string(),
                     .assignments = {std::string("runtime.mode=") + GetParam()},
                     .plugin_folders = {build_folder() / "lib/stillpoint/plugins"}},
                    registry);
  Stages stages = make_stages(config, folder.path(), [](LogLevel, std::string_view) {});
  const auto closer = std::make_shared<CheckedLoopCloser>(stages.loop_closer.object);
  stages.loop_closer.object = closer;
  Engine(std::move(stages), config.runtime, config.segmentation).run();
  EXPECT_GE(closer->loops(), 1);
  EXPECT_EQ(closer->adjustments(), closer->loops());
  EXPECT_LT(absolute_error(recording, folder.path() / "trajectory.txt"), most_error());
}

INSTANTIATE_TEST_SUITE_P(Modes, LoopClosing, ::testing::Values("inline", "threaded"),
                         [](const auto& mode) { return std::string(mode.param); });

}  // namespace
}  // namespace stillpoint::testing
