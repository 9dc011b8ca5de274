// A pipeline of test doubles.
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "doubles.hpp"
#include "stillpoint/engine/engine.hpp"
#include "stillpoint/runtime/worker.hpp"

namespace stillpoint::testing {

struct EngineFixture {
  explicit EngineFixture(std::uint32_t frames = 6)
      : source(std::make_shared<FakeSource>(calls, frames)) {}

  Stages stages() {
    return {.source = {source, "list"},
            .segmenter = {std::make_shared<FakeSegmenter>(calls), "net"},
            .propagator = {std::make_shared<FakePropagator>(calls), "flow"},
            .moving_checker = {std::make_shared<FakeChecker>(calls), "lk"},
            .decision = {std::make_shared<FakeDecision>(calls), "vote"},
            .tracker = {std::make_shared<FakeTracker>(calls), "orb"},
            .local_mapper = {mapper, "orb"},
            .loop_closer = {closer, "bits"},
            .map_backend = {backend, "cloud"},
            .outputs = {{{output, "first"}}, {{second_output, "second"}}},
            .map_directory = ::testing::TempDir() + "stillpoint_pipeline_test"};
  }

  CallLog calls;
  std::shared_ptr<Source> source;
  std::shared_ptr<FakeMapper> mapper = std::make_shared<FakeMapper>(calls);
  std::shared_ptr<LoopCloser> closer = std::make_shared<FakeCloser>(calls);
  std::shared_ptr<FakeBackend> backend = std::make_shared<FakeBackend>(calls);
  std::shared_ptr<FakeOutput> output = std::make_shared<FakeOutput>(calls);
  CallLog second_calls;
  std::shared_ptr<FakeOutput> second_output = std::make_shared<FakeOutput>(second_calls);
};

inline RuntimeOptions runtime(Mode mode, RuntimeOptions::Pace pace = RuntimeOptions::Pace::kFree) {
  RuntimeOptions options;
  options.mode = mode;
  options.pace = pace;
  return options;
}

}  // namespace stillpoint::testing
