// Saves the sparse map at the end of a run, also of one that failed or was interrupted.
#pragma once

#include <filesystem>
#include <utility>

#include "stillpoint/engine/map_file.hpp"
#include "stillpoint/sdk.hpp"

namespace stillpoint {

class MapSaver final : public Output {
 public:
  /// Throws Error when the file could not be written.
  explicit MapSaver(std::filesystem::path file) : file_(std::move(file)) {
    require_writable(file_);
  }
  void finish(const RunSummary& summary) override { save_map(summary.map, file_); }

 private:
  std::filesystem::path file_;
};

}  // namespace stillpoint
