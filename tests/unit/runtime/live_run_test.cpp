// What outputs may do with a run while it goes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <thread>

#include "engine_fixture.hpp"
#include "stillpoint/engine/map_file.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;
using testing::EngineFixture;
using testing::runtime;
using Strings = std::vector<std::string>;

/// An output that keeps the run, and may pause it before its first frame.
class Steering final : public Output {
 public:
  void begin(const std::shared_ptr<LiveRun>& begun) override {
    run = begun;
    if (pauses) pause = run->pause();
    if (on_begin) on_begin();
  }
  void frame(const FrameReport&) override {
    if (on_frame) on_frame();
  }

  bool pauses = false;
  std::function<void()> on_begin, on_frame;
  std::shared_ptr<LiveRun> run;
  LiveRun::Pause pause;
};

class LiveRunTest : public ::testing::TestWithParam<Mode> {
 protected:
  Stages stages() {
    Stages all = fixture.stages();
    all.outputs.push_back({{steering, "steering"}});
    all.map_file = map_file;
    return all;
  }
  Engine engine() { return {stages(), runtime(GetParam()), {}}; }

  EngineFixture fixture{4};
  std::shared_ptr<Steering> steering = std::make_shared<Steering>();
  const testing::TemporaryFolder folder;
  fs::path map_file = folder.path() / "saved.map";
};
INSTANTIATE_TEST_SUITE_P(Modes, LiveRunTest, ::testing::Values(Mode::kInline, Mode::kThreaded),
                         [](const auto& test) {
                           return test.param == Mode::kInline ? "Inline" : "Threaded";
                         });

TEST_P(LiveRunTest, PausedItTracksOneFrameForEachStep) {
  steering->pauses = true;
  std::thread viewer([&] {
    fixture.calls.wait_for("source 0");  // after begin()
    for (std::uint32_t frame = 0; frame < 2; ++frame) {
      fixture.calls.write("step", frame);
      steering->run->step();
      fixture.calls.wait_for("output " + std::to_string(frame));
    }
    fixture.calls.write("go on", 2);
    steering->pause.reset();
  });
  engine().run();
  viewer.join();
  Strings steps;
  for (const std::string& entry : fixture.calls.entries())
    if (entry.starts_with("track ") || entry.starts_with("step ") || entry.starts_with("go on "))
      steps.push_back(entry);
  EXPECT_EQ(steps,
            (Strings{"step 0", "track 0", "step 1", "track 1", "go on 2", "track 2", "track 3"}));
  EXPECT_TRUE(fixture.output->complete);
}

TEST_P(LiveRunTest, GoesOnWhenTheLastPauseIsGone) {
  steering->on_begin = [this] {
    LiveRun::Pause another = steering->run->pause();
    steering->pause = steering->run->pause();
    another.reset();
  };
  std::thread viewer([&] {
    fixture.calls.wait_for("source 0");
    fixture.calls.write("go on", 0);
    steering->pause.reset();
  });
  engine().run();
  viewer.join();
  const Strings entries = fixture.calls.entries();
  EXPECT_LT(std::ranges::find(entries, "go on 0"), std::ranges::find(entries, "track 0"));
  EXPECT_EQ(fixture.calls.entries("track").size(), 4u);
}

TEST_P(LiveRunTest, AStepWithoutAPauseIsNoneLater) {
  steering->pauses = true;
  steering->on_begin = [this] {
    steering->run->step();
    steering->pause.reset();  // the step was for this pause
    steering->run->step();
    steering->pause = steering->run->pause();
  };
  std::stop_source stop;
  std::thread viewer([&] {
    fixture.calls.wait_for("source 0");
    stop.request_stop();
  });
  engine().run(stop.get_token());
  viewer.join();
  EXPECT_THAT(fixture.calls.entries("track"), ::testing::IsEmpty());
}

TEST_P(LiveRunTest, StopsAsAfterCtrlCAndAlsoWhenPaused) {
  steering->pauses = true;
  steering->on_begin = [this] { steering->run->stop(); };
  engine().run();
  EXPECT_THAT(fixture.calls.entries("track"), ::testing::IsEmpty());
  EXPECT_FALSE(fixture.output->complete);
  EXPECT_EQ(fixture.output->failure, "");
  EXPECT_EQ(fixture.output->finished, 1);
}

TEST_P(LiveRunTest, SavesTheMapWhereTheProgramSays) {
  steering->on_frame = [this] { steering->run->save_map(); };
  engine().run();
  EXPECT_EQ(steering->run->map_file(), map_file);
  EXPECT_GT(load_map(map_file).keyframe_id_end(), 0u);
}

// Also where an output catches what it is told: what has crashed cannot be gone on with.
TEST_P(LiveRunTest, ADenseMapThatCannotBeReadEndsTheRun) {
  fixture.backend->fails_once = true;
  bool told = false;
  steering->on_frame = [&] {
    try {
      while (!told) steering->run->dense_map();
    } catch (const Error&) {
      told = true;
    }
  };
  try {
    engine().run();
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("dense mapping (cloud) failed: a broken cell"));
  }
  EXPECT_TRUE(told);
  EXPECT_EQ(fixture.output->finished, 1);
  EXPECT_THAT(fixture.calls.entries("save"), ::testing::SizeIs(1));
}

TEST_P(LiveRunTest, SavesTheDenseMapAtTheLatestWhenNoKeyFrameIsBeingMapped) {
  const fs::path dense = folder.path() / "dense";
  bool saved = false;
  steering->on_frame = [&] {
    for (int i = 0; i < 1'000'000 && !saved; ++i) saved = steering->run->save_dense_map(dense);
  };
  engine().run();
  EXPECT_TRUE(saved);
  EXPECT_TRUE(fs::is_directory(dense));
  EXPECT_THAT(fixture.calls.entries("save"), ::testing::SizeIs(2));  // and at the end
}

TEST_P(LiveRunTest, SavesNoDenseMapBeforeThereIsOneOrWhileAKeyFrameIsBeingMapped) {
  bool saved = false;
  const fs::path dense = folder.path() / "dense";
  steering->on_begin = [&] { saved |= steering->run->save_dense_map(dense); };
  fixture.backend->while_integrating = [&] {
    std::thread([&] { saved |= steering->run->save_dense_map(dense); }).join();
  };
  engine().run();
  EXPECT_FALSE(saved);
  EXPECT_FALSE(fs::exists(dense));
}

TEST_P(LiveRunTest, ReachesNothingAfterTheEnd) {
  engine().run();  // the engine is gone, the run is kept
  EXPECT_THROW(steering->run->save_map(), Error);
  EXPECT_FALSE(steering->run->dense_map());
  EXPECT_FALSE(steering->run->save_dense_map(folder.path() / "after_the_end"));
  EXPECT_TRUE(steering->run->pause());
  steering->run->step();
  steering->run->stop();
}

TEST_P(LiveRunTest, SavesNothingWithoutAFile) {
  map_file.clear();
  std::string message;
  steering->on_begin = [&] {
    try {
      steering->run->save_map();
    } catch (const Error& error) {
      message = error.what();
    }
  };
  engine().run();
  EXPECT_THAT(message, ::testing::HasSubstr("no file"));
}

TEST_P(LiveRunTest, AFailureOfBeginIsNamed) {
  steering->on_begin = [] { throw std::runtime_error("no port"); };
  try {
    engine().run();
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("output (steering) failed: no port"));
  }
  EXPECT_EQ(fixture.output->finished, 1);
}

// It is shown, and its map saved, but nobody holds up the program.
TEST_P(LiveRunTest, OfFramesThatAProgramGivesCannotBeSteered) {
  Engine engine = this->engine();
  engine.process(testing::make_frame(0));
  ASSERT_TRUE(steering->run);
  EXPECT_FALSE(steering->run->steerable());
  {
    const LiveRun::Pause pause = steering->run->pause();
    EXPECT_TRUE(engine.process(testing::make_frame(1)));
  }
  steering->run->stop();
  EXPECT_TRUE(engine.process(testing::make_frame(2)));
  steering->run->save_map();
  EXPECT_TRUE(fs::exists(map_file));
  engine.finish();
  EXPECT_EQ(steering->run->dense_map(), std::nullopt) << "after the end";
}

TEST_P(LiveRunTest, OfARecordingCanBeSteered) {
  steering->on_begin = [&] { EXPECT_TRUE(steering->run->steerable()); };
  Engine engine = this->engine();
  engine.run();
  EXPECT_TRUE(steering->run);
}

}  // namespace
}  // namespace stillpoint
