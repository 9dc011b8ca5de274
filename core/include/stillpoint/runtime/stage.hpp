// The boxes of a pipeline as the runtime holds them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "stillpoint/runtime/null_stages.hpp"
#include "stillpoint/runtime/stage_error.hpp"
#include "stillpoint/runtime/time_log.hpp"
#include "stillpoint/sdk.hpp"

namespace stillpoint {

/// An implementation and what the pipeline file calls it. Without an object: the null stage.
template <class Interface>
struct Stage {
  std::shared_ptr<Interface> object;
  std::string type;
};

/// What becomes of a report when an output is too slow to take it.
enum class WhenFull { kWait /* tracking waits */, kDrop /* the report that waited longest goes */ };

struct OutputSetup {
  Stage<Output> stage;
  WhenFull when_full = WhenFull::kWait;
};

/// What sits in each box. Made from a pipeline file, or by hand for tests.
struct Stages {
  Stage<Source> source;  ///< must be there
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
};

/// Calls a stage: names it when it fails and measures it. Null stages are not measured.
template <class Interface>
class StageCaller {
 public:
  /// `role` is what messages call the stage: "local mapping".
  StageCaller(Stage<Interface> stage, const std::string& role, TimeLog& times)
      : present_(stage.object != nullptr),
        object_(present_ ? std::move(stage.object) : make_null_stage<Interface>()),
        name_(stage.type.empty() ? role : role + " (" + stage.type + ")"),
        times_(times) {}

  /// Calls a member function; `label` names its time.
  template <class Function, class... Arguments>
  auto call(const char* label, std::uint32_t frame, Function function, Arguments&&... arguments) {
    std::optional<ScopedTime> time;
    if (present_) time.emplace(times_, label, frame);
    return call_unmeasured(frame, function, std::forward<Arguments>(arguments)...);
  }

  template <class Function, class... Arguments>
  auto call_unmeasured(std::optional<std::uint32_t> frame, Function function,
                       Arguments&&... arguments) {
    return in_stage(name_, frame, [&] {
      return std::invoke(function, *object_, std::forward<Arguments>(arguments)...);
    });
  }

  bool present() const { return present_; }
  Interface& object() const { return *object_; }

 private:
  bool present_;
  std::shared_ptr<Interface> object_;
  std::string name_;
  TimeLog& times_;
};

}  // namespace stillpoint
