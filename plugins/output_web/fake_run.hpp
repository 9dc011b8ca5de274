// A run for tests.
#pragma once

#include <filesystem>
#include <mutex>
#include <optional>
#include <stillpoint/sdk.hpp>
#include <string>
#include <vector>

namespace stillpoint::output_web {

/// Writes down what it is told.
class FakeRun final : public LiveRun {
 public:
  bool steerable() const override { return steers; }
  Pause pause() override {
    write("pause");
    return {this, [this](const void*) { write("go on"); }};
  }
  void step() override { write("step"); }
  void stop() override { write("stop"); }
  std::optional<std::vector<LabelledPoint>> dense_map() override {
    return busy_reads-- > 0 ? std::nullopt : dense;
  }
  bool save_dense_map(const std::filesystem::path&) override { return false; }
  std::filesystem::path map_file() const override { return "/secret/folder/room.map"; }
  void save_map() override {
    write("save");
    if (disk_is_full) throw Error(Fault::kUsage, "no room left");
  }

  std::vector<std::string> calls() const {
    const std::lock_guard lock(mutex_);
    return calls_;
  }
  // Set before the run.
  bool disk_is_full = false;
  bool steers = true;
  std::optional<std::vector<LabelledPoint>> dense;
  int busy_reads = 0;  // of the dense map, before there is one that succeeds

 private:
  void write(const std::string& call) {
    const std::lock_guard lock(mutex_);
    calls_.push_back(call);
  }
  mutable std::mutex mutex_;
  std::vector<std::string> calls_;
};

}  // namespace stillpoint::output_web
