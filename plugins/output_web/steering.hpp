// What viewers make the run do, and what all of them are to know of it.
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <stillpoint/sdk.hpp>
#include <string>

#include "output_web/request.hpp"

namespace stillpoint::output_web {

/// Used on the server's thread. A viewer is known by its address.
class Steering {
 public:
  using Log = std::function<void(LogLevel, std::string_view)>;
  Steering(bool allowed, Log log) : allowed_(allowed), log_(std::move(log)) {}

  void begin(std::shared_ptr<LiveRun> run) { run_ = std::move(run); }
  /// False where viewers may only look. Before begin(), nothing happens.
  bool execute(const void* viewer, Command command);
  /// A pause ends with the last viewer that has asked for it. Whether that was so.
  bool leave(const void* viewer);

  /// JSON: `allowed`; `steerable`, as of LiveRun; `paused`, `ending`; `map_file`, where the map
  /// would be saved, without its folder; `notes`, how many there have been, and `note`, the last of
  /// them.
  std::string state() const;

 private:
  void save_map();
  void note(LogLevel level, std::string text);

  const bool allowed_;
  const Log log_;
  std::shared_ptr<LiveRun> run_;
  std::set<const void*> pausing_viewers_;
  LiveRun::Pause pause_;
  bool ending_ = false;
  int notes_ = 0;
  std::string note_;
};

}  // namespace stillpoint::output_web
