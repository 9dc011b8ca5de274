// What a program may have the engine call: Stages::before_outputs and map_saved.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine_fixture.hpp"
#include "stillpoint/error.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint {
namespace {

using testing::EngineFixture;
using testing::runtime;

class EngineHooks : public ::testing::TestWithParam<Mode> {};
INSTANTIATE_TEST_SUITE_P(Modes, EngineHooks, ::testing::Values(Mode::kInline, Mode::kThreaded),
                         [](const auto& test) {
                           return test.param == Mode::kInline ? "Inline" : "Threaded";
                         });

TEST_P(EngineHooks, BeforeOutputsIsCalledOnceAndBeforeEveryOutput) {
  for (const std::uint32_t frames : {0, 3}) {
    EngineFixture f(frames);
    Stages stages = f.stages();
    for (OutputSetup& output : stages.outputs) {
      output.stage.object = std::make_shared<testing::FakeOutput>(f.calls);
      output.when_full = &output == &stages.outputs.front() ? WhenFull::kWait : WhenFull::kDrop;
    }
    stages.before_outputs = [&f] { f.calls.write("before", 0); };
    Engine(std::move(stages), runtime(GetParam()), {}).run();
    const auto calls = f.calls.entries();
    EXPECT_EQ(std::ranges::count(calls, "before 0"), 1);
    const auto begun = std::ranges::find(calls, "before 0");
    EXPECT_EQ(std::find_if(calls.begin(), begun,
                           [](const auto& call) {
                             return call.starts_with("output") || call.starts_with("finish");
                           }),
              begun);
  }
}

TEST_P(EngineHooks, WhatFailsBeforeTheOutputsEndsTheRunForThemBeforeItsFirstFrame) {
  for (const std::uint32_t frames : {0, 3}) {
    EngineFixture f(frames);
    Stages stages = f.stages();
    stages.before_outputs = [] { throw Error(Fault::kUsage, "no room"); };
    Engine engine(std::move(stages), runtime(GetParam()), {});
    EXPECT_THROW(engine.run(), Error);
    EXPECT_TRUE(f.output->before_first_frame);
    EXPECT_EQ(f.calls.entries("output"), std::vector<std::string>());
    EXPECT_EQ(f.calls.entries("save"), std::vector<std::string>())
        << "no dense map beside that of an earlier run";
  }
}

TEST_P(EngineHooks, TheFilesOfTheDenseMapAreNamedAlsoWhereItsBackEndFails) {
  for (const bool fails : {false, true}) {
    const testing::TemporaryFolder folder;
    folder.write("map/the_users", "");
    EngineFixture f(3);
    f.backend->while_saving = [&](const std::filesystem::path& directory) {
      folder.write("map/parts/first", "");
      EXPECT_EQ(directory, folder.path() / "map");
      if (fails) throw std::runtime_error("no more");
    };
    Stages stages = f.stages();
    stages.map_directory = folder.path() / "map";
    std::vector<std::filesystem::path> files;
    stages.map_saved = [&](const auto& written) { files = written; };
    Engine engine(std::move(stages), runtime(GetParam()), {});
    if (fails)
      EXPECT_THROW(engine.run(), Error);
    else
      engine.run();
    EXPECT_EQ(files, std::vector<std::filesystem::path>{"parts/first"});
  }
}

}  // namespace
}  // namespace stillpoint
