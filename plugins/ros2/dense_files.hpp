// Octree and cost map of a run while it goes, made into messages beside it.
#pragma once

#include <chrono>
#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <stillpoint/sdk.hpp>
#include <utility>

#include "ros2_messages/messages.hpp"

namespace stillpoint::ros2 {

/// What a map back end has written; nothing for what it does not write or nobody wants.
struct DenseFiles {
  double time = 0;  // seconds: of the newest frame when writing began
  std::optional<ros2_messages::Octree> octree;
  std::optional<ros2_messages::OccupancyGrid> grid;
};

struct DenseFilesWanted {
  bool octree = false;
  bool grid = false;
};

/// Of the files in `folder`, written at `time`. Throws Error when they cannot be read.
DenseFiles read_dense_files(const std::filesystem::path& folder, DenseFilesWanted wanted,
                            double time);

/// The map back end writes all its files, which takes tenths of a second, or seconds after a loop:
/// a thread of its own waits for it. Used by one thread at a time.
class DenseFilesReader {
 public:
  /// From one time to the next pass `period_seconds`, or twenty times what the last one took.
  DenseFilesReader(std::shared_ptr<LiveRun> run, double period_seconds)
      : run_(std::move(run)), period_(period_seconds) {}

  /// To be called with every frame: begins when it is time, and gives what has been read since;
  /// mostly nothing. Throws what saving and reading threw; the next call goes on.
  std::optional<DenseFiles> next(double time, DenseFilesWanted wanted);

 private:
  struct Read {
    std::optional<DenseFiles> files;  // nothing: ask again later
    std::chrono::duration<double> took{};
  };
  static Read save_and_read(LiveRun& run, DenseFilesWanted wanted, double time);

  static constexpr double kFirstRetry = 0.2;  // seconds

  const std::shared_ptr<LiveRun> run_;
  const double period_;  // seconds, of the frames
  double next_ = 0;      // a time of frames
  double retry_period_ = kFirstRetry;
  std::future<Read> read_;
};

}  // namespace stillpoint::ros2
