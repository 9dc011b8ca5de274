// What sits in each box of the paper's Fig. 2.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "stillpoint/sdk.hpp"

namespace stillpoint {

/// An implementation and what messages call it, the `type` of a pipeline file. Without an object:
/// the box is left out.
template <class Interface>
struct Stage {
  std::shared_ptr<Interface> object;
  std::string type;
};

/// What becomes of a report when an output is too slow to take it.
enum class WhenFull {
  kAuto,  ///< as Output::may_miss_frames() says
  kWait,  ///< tracking waits
  kDrop   ///< the oldest report is dropped
};

struct OutputSetup {
  Stage<Output> stage;
  WhenFull when_full = WhenFull::kAuto;
};

/// Made from a pipeline file by make_stages(), or by hand.
struct Stages {
  Stage<Source> source;  ///< needed by Engine::run() alone
  Stage<Segmenter> segmenter;
  Stage<Propagator> propagator;
  Stage<MovingChecker> moving_checker;
  Stage<MapChecker> map_checker;
  Stage<Decision> decision;
  Stage<Tracker> tracker;
  Stage<LocalMapper> local_mapper;
  Stage<LoopCloser> loop_closer;
  Stage<MapBackend> map_backend;
  std::vector<OutputSetup> outputs;
  std::filesystem::path map_directory;  ///< made for the dense map at the end; empty: not saved
  SparseMap known_map;                  ///< to begin with; empty: the first frame begins one
  bool localise_only = false;           ///< the map stays as it is
  /// What the user of the run should know, from the thread that tracks. May be empty.
  std::function<void(LogLevel, std::string_view)> log;
  /// Where outputs may have the sparse map saved while the run goes (LiveRun); empty: nowhere.
  std::filesystem::path map_file;
  /// Called once by the thread that tracks: when the first frame is through, before an output has
  /// it, or at the end of a source without a frame. What it throws ends the run. May be empty.
  std::function<void()> before_outputs;
  /// Called once by the thread that finishes, when the dense map has been saved, also where that
  /// has failed: which files its back end has written, relative to map_directory. May be empty.
  std::function<void(const std::vector<std::filesystem::path>&)> map_saved;
};

}  // namespace stillpoint
