// The run as outputs reach it, and where tracking waits while it is paused.
#pragma once

#include <atomic>
#include <condition_variable>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <stop_token>
#include <vector>

#include "stillpoint/contracts/live_run.hpp"
#include "stillpoint/runtime/map_store.hpp"

namespace stillpoint {

/// Outlives the pipeline where an output keeps it.
class ControlledRun final : public LiveRun, public std::enable_shared_from_this<ControlledRun> {
 public:
  /// Parts of the pipeline, which are called from any thread, until end().
  struct Reach {
    std::function<MapStore::Snapshot()> map;
    std::function<std::optional<std::vector<LabelledPoint>>()> dense_map;
    std::function<bool(const std::filesystem::path&)> save_dense_map;
  };
  ControlledRun(Reach reach, std::filesystem::path map_file)
      : map_file_(std::move(map_file)), reach_(std::move(reach)) {}

  bool steerable() const override { return steerable_; }
  Pause pause() override;
  void step() override;
  void stop() override { stop_.request_stop(); }
  std::optional<std::vector<LabelledPoint>> dense_map() override;
  bool save_dense_map(const std::filesystem::path& directory) override;
  std::filesystem::path map_file() const override { return map_file_; }
  void save_map() override;

  /// Before outputs have it, when a program gives the frames.
  void give_up_steering() { steerable_ = false; }
  /// Requested by stop().
  std::stop_token stop_token() const { return stop_.get_token(); }
  bool paused() const;
  /// Returns when the run is not paused, for a step, or after a stop.
  void wait_while_paused(std::stop_token stop);
  /// Of waiting, in total.
  double paused_seconds() const;
  /// Nothing of the pipeline is called any more, nor under way.
  void end();

 private:
  void resume();

  const std::filesystem::path map_file_;
  std::stop_source stop_;
  std::atomic<bool> steerable_ = true;

  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  int pauses_ = 0;     // guarded by mutex_, like the next two
  bool step_ = false;  // one frame may begin
  double paused_seconds_ = 0.0;

  std::shared_mutex reach_mutex_;  // shared by calls, which may be long; end() waits for them
  std::optional<Reach> reach_;     // guarded by reach_mutex_; nothing after end()
  std::mutex save_mutex_;          // two would write into one file
};

}  // namespace stillpoint
