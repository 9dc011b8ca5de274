// Stillpoint as a library: RGB-D frames go in, poses and a map come out.
//
//   Engine engine({.request = {.pipeline = "stillpoint", .pushed = true}});
//   const Rectifier rectifier(load_camera("tum_fr3"));
//   while (…) {
//     const FrameReportPtr report = engine.process(rectifier.frame(time, bgr, depth));
//     if (report->result.state == TrackState::kTracking) use(report->result.world_from_camera);
//   }
//   engine.finish();
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <stop_token>
#include <string_view>
#include <vector>

#include "stillpoint/engine/pace_clock.hpp"
#include "stillpoint/engine/pipeline_config.hpp"
#include "stillpoint/engine/stages.hpp"
#include "stillpoint/export.hpp"

namespace stillpoint {

/// Warnings and errors to stderr, a line each.
STILLPOINT_EXPORT void log_to_stderr(LogLevel level, std::string_view text);

/// What an engine is made from, a pipeline file above all.
struct EngineSetup {
  PipelineRequest request;
  /// Created when missing, and locked until the end: no other engine or run can use it. The
  /// pipeline's outputs write into it, the dense map into its folder `map`. Empty: no outputs, and
  /// the dense map is not saved.
  std::filesystem::path output_directory;
  SparseMap known_map;         ///< to begin with, see load_map(); empty: the first frame begins one
  bool localise_only = false;  ///< the known map stays as it is
  /// Called from any thread, also by several at once.
  std::function<void(LogLevel, std::string_view)> log = log_to_stderr;
};

/// One run of a pipeline. process(), run(), finish(), poses() and trajectory() are called from one
/// thread, which is thread 1 of the paper's Fig. 2, tracking; `runtime.mode: threaded` has the
/// others behind it.
///
/// A failure of a stage, on any thread, ends the run: process(), run() or finish() throws an Error
/// that names the stage and the frame. What was computed until then stays available.
class STILLPOINT_EXPORT Engine {
 public:
  /// Throws ConfigError with every fault of the configuration, or Error when a stage cannot be
  /// made. `abi` is left as it is: it says how the calling program was compiled, and Error(kUsage)
  /// is thrown where its objects have another layout than the library's.
  explicit Engine(EngineSetup setup, std::string_view abi = kAbiTag);
  /// From objects. `clock` is what `pace: sensor` goes by; null: the steady clock.
  Engine(Stages stages, const RuntimeOptions& runtime, const SegmentationOptions& segmentation,
         std::shared_ptr<PaceClock> clock = nullptr, std::string_view abi = kAbiTag);
  /// Without finish() before, stops like Ctrl-C: outputs are finished, failures are not reported.
  ~Engine();
  Engine(Engine&&) noexcept;
  Engine& operator=(Engine&&) = delete;

  /// Estimates the pose of the next frame. Its `index` is given here; a missing `gray` is made from
  /// `bgr`. The images are shared with other threads, not copied: never write them afterwards.
  ///
  /// In mode `inline`, the frame is processed completely at return. In mode `threaded`, mapping
  /// goes on: world_from_camera of the report is the pose in the map of that moment, and
  /// trajectory() may give a better one later.
  ///
  /// Throws Error(kData) for a frame that cannot be used (other size than its camera, depth that is
  /// not CV_32FC1, time that runs backwards); it is ignored, and the next may follow.
  FrameReportPtr process(Frame frame);

  /// Feeds all frames of the pipeline's source, then finish(). Ends early after a stop, with what
  /// was computed saved.
  void run(std::stop_token stop = {});

  /// Waits until the maps know all key frames, saves the dense map and finishes outputs. Once; no
  /// frame may follow.
  void finish();

  /// A snapshot that never changes. From any thread, at any time.
  std::shared_ptr<const SparseMap> map() const;
  /// What the dense map holds now, in the world; it is some key frames behind. Nothing without a
  /// map back end. From any thread, at any time; waits for the key frame that is being mapped.
  std::vector<LabelledPoint> dense_map() const;
  /// Writes the files of the dense map as it is now into `directory`, which is created when
  /// missing. False: there is no map back end. Throws Error when they cannot be written. From any
  /// thread, at any time; dense mapping waits meanwhile.
  bool save_dense_map(const std::filesystem::path& directory) const;
  /// Of the segmenter, by label: of images, objects and the dense map. Empty without one.
  const ClassNames& classes() const;
  /// Of every frame processed, in order.
  const std::vector<TrackedPose>& poses() const;
  /// Of the frames that were tracked, in the current map.
  std::vector<StampedPose> trajectory() const;

 private:
  std::unique_ptr<class FolderLock> lock_;  // of the output directory
  std::unique_ptr<class Pipeline> pipeline_;
};

}  // namespace stillpoint
