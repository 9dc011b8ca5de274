// `stillpoint ablate` in a folder of its own, and studies for it.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "support/program.hpp"

namespace stillpoint::testing {

class AblateTest : public ::testing::Test {
 protected:
  Outcome ablate(const std::string& text, std::vector<std::string> more = {}) {
    const std::string file = folder_.write("study.yaml", text).string();
    std::vector<std::string> arguments = {"ablate", file, "-o", out().string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return call(arguments);
  }
  std::filesystem::path out() const { return folder_.path() / "out"; }

  TemporaryFolder folder_;
};

/// Two runs.
inline constexpr const char* kTiny =
    "version: 1\n"
    "sequences:\n"
    "  - {name: tiny, scene: fr3_walking_xyz_empty, frames: 30, set: [camera.width=320, "
    "camera.height=240, camera.fx=267.7, camera.fy=269.6, camera.cx=159.8, camera.cy=123.6]}\n"
    "variants:\n"
    "  - {name: few, pipeline: orb_baseline, set: [tracker.features=600]}\n"
    "  - {name: many, pipeline: orb_baseline, set: [tracker.features=1000]}\n"
    "mode: inline\n"
    "baseline: few\n";

/// The same in a few frames, for what happens around the runs.
inline const std::string kShort = [] {
  std::string text = kTiny;
  return text.replace(text.find("frames: 30"), 10, "frames: 5");
}();

}  // namespace stillpoint::testing
