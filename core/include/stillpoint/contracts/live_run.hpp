// A run as its outputs can reach it while it goes: for those that show it to somebody.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "stillpoint/contracts/labelled_point.hpp"
#include "stillpoint/export.hpp"

namespace stillpoint {

/// From any thread, also when the run has ended: then pause(), step() and stop() change nothing.
/// Nothing waits for the run.
class STILLPOINT_EXPORT LiveRun {
 public:
  virtual ~LiveRun();

  /// Whether pause(), step() and stop() change anything. Not where a program gives the frames
  /// itself (Engine::process()): it decides when the next one comes.
  virtual bool steerable() const { return true; }

  /// Whoever has one keeps the run paused.
  using Pause = std::shared_ptr<const void>;
  /// No frame begins before all pauses are gone; the one under way is finished, and mapping goes
  /// on. A recording waits, with `pace: sensor` as well; what a camera sees meanwhile is lost.
  /// Ctrl-C ends a paused run, too.
  [[nodiscard]] virtual Pause pause() = 0;
  /// While the run is paused: one frame, after the one under way.
  virtual void step() = 0;
  /// Like Ctrl-C: the frame under way is the last one, and what was computed is saved.
  virtual void stop() = 0;

  /// What the dense map holds now, as MapBackend::occupied(). Nothing while a key frame is being
  /// mapped: ask again later; nothing either without a dense map or after the run.
  virtual std::optional<std::vector<LabelledPoint>> dense_map() = 0;
  /// Writes the files of the dense map as it is now into `directory`, which is created when
  /// missing. Dense mapping waits meanwhile: tenths of a second for a room, seconds after a loop.
  /// False: nothing was written, because a key frame is being mapped or none has been yet (ask
  /// again later), there is no dense map, or the run has ended. Throws Error when the files cannot
  /// be written.
  virtual bool save_dense_map(const std::filesystem::path& directory) = 0;

  /// Where save_map() writes; empty: the program has named no file.
  virtual std::filesystem::path map_file() const = 0;
  /// Writes the sparse map as it is now, which takes some time. Throws Error when that is not
  /// possible: without a file, after the run.
  virtual void save_map() = 0;
};

}  // namespace stillpoint
