// A run to be reported.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>

#include "support/program.hpp"
#include "support/simulated_recording.hpp"

namespace stillpoint::testing {

/// A run with pictures and a dense map, made once for all tests of the process.
inline const std::filesystem::path& finished_run() {
  static const TemporaryFolder folder;
  static const std::filesystem::path run = [] {
    const std::filesystem::path path = folder.path() / "a run";
    const Outcome outcome =
        call({"run", "stillpoint", "--dataset", recording_with_people().string(), "-o",
              path.string(), "--quiet", "--images", "--with", "web.port=0", "--with",
              "web.record=live.html", "--set", "runtime.mode=inline"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
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
