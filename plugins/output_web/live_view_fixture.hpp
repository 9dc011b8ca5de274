// The output at a free port, with nobody looking yet.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <stillpoint/testing/test_recording.hpp>
#include <vector>

#include "output_web/test_reports.hpp"
#include "output_web/test_viewer.hpp"
#include "output_web/web_output.hpp"

namespace stillpoint::output_web {

class LiveView : public ::testing::Test {
 protected:
  std::unique_ptr<WebOutput> make(const WebOutput::Options& options) const {
    return std::make_unique<WebOutput>(options, testing::test_context());
  }
  static std::uint16_t port(const WebOutput& output) { return port_of(output.url()); }
  static void finish(WebOutput& output) {
    const SparseMap map;
    const std::vector<TrackedPose> poses;
    SourceReport source;
    source.skipped = 3;
    const std::vector<StageTime> times;
    output.finish({.map = map, .poses = poses, .source = source, .times = times});
  }

  std::unique_ptr<WebOutput> output = make({.port = 0});
};

}  // namespace stillpoint::output_web
