// A run to be reported.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "support/program.hpp"
#include "support/simulated_recording.hpp"

namespace stillpoint::testing {

/// Of what the run is made by, and from.
inline std::filesystem::file_time_type newest_of_run() {
  namespace fs = std::filesystem;
  auto newest = std::max(fs::last_write_time(program_file()),
                         fs::last_write_time(recording_with_people() / "done"));
  for (const fs::path& folder :
       {fs::path(STILLPOINT_BINARY_DIR) / "lib", fs::path(STILLPOINT_SOURCE_DIR) / "configs"})
    for (const auto& file : fs::recursive_directory_iterator(folder))
      if (file.is_regular_file()) newest = std::max(newest, file.last_write_time());
  return newest;
}

/// A run with pictures and a dense map; a copy for each process.
inline const std::filesystem::path& finished_run() {
  static const TemporaryFolder folder;
  static const std::filesystem::path run = [] {
    const std::filesystem::path& recording = recording_with_people();
    const auto make = [&](const std::filesystem::path& path) {
      const Outcome outcome =
          call({"run", "stillpoint", "--dataset", recording.string(), "-o", path.string(),
                "--quiet", "--images", "--with", "web.port=0", "--with", "web.record=live.html",
                "--set", "runtime.mode=inline"});
      if (outcome.exit_code != 0) throw std::runtime_error("run failed: " + outcome.err);
    };
    const std::filesystem::path original = made_once("finished_run", newest_of_run(), make);
    const std::filesystem::path path = folder.path() / "a run";
    std::filesystem::copy(original, path, std::filesystem::copy_options::recursive);
    std::filesystem::remove(path / "done");
    return path;
  }();
  return run;
}

inline bool page_is_built() {
  return std::filesystem::exists(std::filesystem::path(STILLPOINT_BINARY_DIR) /
                                 "share/stillpoint/report.html");
}

#define SKIP_WITHOUT_PAGE() \
  if (!page_is_built()) GTEST_SKIP() << "built without the page: npm or esbuild are missing"

}  // namespace stillpoint::testing
