// A run for outputs that reach into it: it does what it is told, but nobody sees it.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "stillpoint/contracts/live_run.hpp"
#include "stillpoint/error.hpp"

namespace stillpoint::plugin_check {

/// Its program has named no file for the sparse map, and its dense map is busy half of the time.
class QuietRun final : public LiveRun {
 public:
  explicit QuietRun(bool steerable) : steerable_(steerable) {}

  bool steerable() const override { return steerable_; }
  Pause pause() override { return std::make_shared<const int>(0); }
  void step() override {}
  void stop() override {}
  std::optional<std::vector<LabelledPoint>> dense_map() override {
    if (asked_++ % 2 == 0) return std::nullopt;
    return std::vector<LabelledPoint>(3);
  }
  bool save_dense_map(const std::filesystem::path&) override { return false; }
  std::filesystem::path map_file() const override { return {}; }
  void save_map() override {
    throw Error(Fault::kUsage, "the program has named no file for the sparse map");
  }

 private:
  const bool steerable_;
  std::atomic<int> asked_ = 0;  // from any thread
};

}  // namespace stillpoint::plugin_check
