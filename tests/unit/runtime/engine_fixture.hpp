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
      : source(std::make_shared<FakeSource>(journal, frames)) {}

  Stages stages() {
    return {.source = {source, "list"},
            .segmenter = {std::make_shared<FakeSegmenter>(journal), "net"},
            .propagator = {std::make_shared<FakePropagator>(journal), "flow"},
            .moving_checker = {std::make_shared<FakeChecker>(journal), "lk"},
            .decision = {std::make_shared<FakeDecision>(journal), "vote"},
            .tracker = {std::make_shared<FakeTracker>(journal), "orb"},
            .local_mapper = {mapper, "orb"},
            .loop_closer = {closer, "bits"},
            .map_backend = {backend, "cloud"},
            .outputs = {{{output, "first"}}, {{second_output, "second"}}},
            .map_directory = ::testing::TempDir() + "stillpoint_pipeline_test"};
  }

  Journal journal;
  std::shared_ptr<Source> source;
  std::shared_ptr<FakeMapper> mapper = std::make_shared<FakeMapper>(journal);
  std::shared_ptr<LoopCloser> closer = std::make_shared<FakeCloser>(journal);
  std::shared_ptr<FakeBackend> backend = std::make_shared<FakeBackend>(journal);
  std::shared_ptr<FakeOutput> output = std::make_shared<FakeOutput>(journal);
  Journal second_journal;
  std::shared_ptr<FakeOutput> second_output = std::make_shared<FakeOutput>(second_journal);
};

inline RuntimeOptions runtime(Mode mode, RuntimeOptions::Pace pace = RuntimeOptions::Pace::kFree) {
  RuntimeOptions options;
  options.mode = mode;
  options.pace = pace;
  return options;
}

}  // namespace stillpoint::testing
