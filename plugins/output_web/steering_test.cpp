// Viewers that steer the run.
#include <nlohmann/json.hpp>

#include "output_web/fake_run.hpp"
#include "output_web/live_view_fixture.hpp"
#include "output_web/steering.hpp"

namespace stillpoint::output_web {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

class Steered : public LiveView {
 protected:
  using Calls = std::vector<std::string>;

  void SetUp() override { output->begin(run); }
  static void tell(TestViewer& viewer, Command command) {
    viewer.send({static_cast<char>(kProtocol), 2, static_cast<char>(command)});
  }
  /// What the viewer is told next of the run's state.
  static Json state(TestViewer& viewer) {
    for (;;) {
      const auto records = viewer.asked();
      if (!records) return {};
      if (const auto found = records->find(Record::kSteering); found != records->end())
        return Json::parse(found->second.at(0));
    }
  }
  static Json state_after(TestViewer& viewer, Command command) {
    tell(viewer, command);
    return state(viewer);
  }

  std::shared_ptr<FakeRun> run = std::make_shared<FakeRun>();
};

TEST_F(Steered, PausesStepsAndGoesOn) {
  TestViewer viewer(port(*output));
  const Json before = state(viewer);
  EXPECT_TRUE(before["allowed"]);
  EXPECT_TRUE(before["steerable"]);
  EXPECT_FALSE(before["paused"]);
  EXPECT_TRUE(state_after(viewer, Command::kPause)["paused"]);
  EXPECT_TRUE(state_after(viewer, Command::kPause)["paused"]);  // it is already
  EXPECT_TRUE(state_after(viewer, Command::kStep)["paused"]);
  EXPECT_FALSE(state_after(viewer, Command::kResume)["paused"]);
  EXPECT_FALSE(state_after(viewer, Command::kStep)["paused"]);  // means nothing now
  EXPECT_EQ(run->calls(), (Calls{"pause", "step", "go on"}));
}

// A robot that gives its frames itself: viewers may have its map saved, and nothing else.
class OfAProgram : public Steered {
 protected:
  void SetUp() override {
    run->steers = false;
    Steered::SetUp();
  }
};

TEST_F(OfAProgram, TheMapIsSavedAndNothingIsSteered) {
  TestViewer viewer(port(*output));
  EXPECT_FALSE(state(viewer)["steerable"]);
  EXPECT_FALSE(state_after(viewer, Command::kPause)["paused"]);
  EXPECT_FALSE(state_after(viewer, Command::kEnd)["ending"]);
  EXPECT_THAT(state_after(viewer, Command::kSaveMap)["note"].get<std::string>(),
              HasSubstr("map saved"));
  EXPECT_EQ(run->calls(), (Calls{"save"}));
}

TEST_F(Steered, AllViewersSeeItAndMayGoOn) {
  TestViewer first(port(*output)), second(port(*output));
  EXPECT_FALSE(state(second)["paused"]);
  tell(first, Command::kPause);
  EXPECT_TRUE(state(second)["paused"]);
  EXPECT_FALSE(state_after(second, Command::kResume)["paused"]);
}

TEST_F(Steered, GoesOnWhenTheViewerThatPausedHasGone) {
  TestViewer witness(port(*output));
  EXPECT_FALSE(state(witness)["paused"]);
  {
    TestViewer viewer(port(*output)), idle(port(*output));
    EXPECT_TRUE(state_after(viewer, Command::kPause)["paused"]);
    EXPECT_TRUE(state(witness)["paused"]);
  }
  EXPECT_FALSE(state(witness)["paused"]);
  EXPECT_EQ(run->calls(), (Calls{"pause", "go on"}));
}

TEST(Steering, APauseLastsWhileAnyViewerThatPausedIsThere) {
  const auto run = std::make_shared<FakeRun>();
  Steering steering(true, [](LogLevel, std::string_view) {});
  steering.begin(run);
  const int first = 1, second = 2, idle = 3;  // by their addresses
  for (const int* viewer : {&first, &second, &second})
    EXPECT_TRUE(steering.execute(viewer, Command::kPause));
  EXPECT_FALSE(steering.leave(&second));
  EXPECT_FALSE(steering.leave(&idle));
  EXPECT_EQ(run->calls(), std::vector<std::string>{"pause"});
  EXPECT_TRUE(steering.leave(&first));
  EXPECT_EQ(run->calls(), (std::vector<std::string>{"pause", "go on"}));

  steering.execute(&first, Command::kPause);
  steering.execute(&second, Command::kResume);
  EXPECT_FALSE(steering.leave(&first));
  EXPECT_EQ(run->calls().size(), 4u);
}

TEST_F(Steered, GoesOnWhenTheServerEnds) {
  TestViewer viewer(port(*output));
  EXPECT_TRUE(state_after(viewer, Command::kPause)["paused"]);
  output.reset();
  EXPECT_EQ(run->calls(), (Calls{"pause", "go on"}));
}

TEST_F(Steered, EndsTheRun) {
  TestViewer viewer(port(*output));
  EXPECT_FALSE(state(viewer)["ending"]);
  EXPECT_TRUE(state_after(viewer, Command::kEnd)["ending"]);
  EXPECT_EQ(run->calls(), (Calls{"stop"}));
}

TEST_F(Steered, SavesTheMapAndTellsNoFolderBefore) {
  TestViewer viewer(port(*output));
  EXPECT_EQ(state(viewer)["map_file"], "room.map");
  const Json saved = state_after(viewer, Command::kSaveMap);
  EXPECT_EQ(saved["notes"], 1);
  EXPECT_THAT(saved["note"].get<std::string>(), HasSubstr("map saved"));
  EXPECT_EQ(run->calls(), (Calls{"save"}));
}

TEST_F(Steered, TellsWhyAMapWasNotSavedAndGoesOn) {
  run->disk_is_full = true;
  TestViewer viewer(port(*output));
  EXPECT_THAT(state_after(viewer, Command::kSaveMap)["note"].get<std::string>(),
              HasSubstr("no room left"));
  EXPECT_TRUE(state_after(viewer, Command::kPause)["paused"]);
}

TEST_F(Steered, BearsAFloodOfCommands) {
  TestViewer flooding(port(*output)), viewer(port(*output));
  for (int round = 0; round < 500; ++round) {
    tell(flooding, Command::kPause);
    tell(flooding, Command::kStep);
    tell(flooding, Command::kResume);
  }
  EXPECT_FALSE(state(flooding)["paused"]);
  EXPECT_EQ(run->calls().size(), 1500u);
  EXPECT_TRUE(state_after(viewer, Command::kPause)["paused"]);
}

TEST_F(Steered, ClosesOnCommandsThatDoNotExist) {
  for (const char wrong : {'\0', '\x06', '\xff'}) {
    TestViewer viewer(port(*output));
    viewer.send({static_cast<char>(kProtocol), 2, wrong});
    EXPECT_FALSE(viewer.next());
    EXPECT_EQ(viewer.close_code(), 1008);
  }
  EXPECT_TRUE(run->calls().empty());
}

TEST_F(Steered, OnlyShowsWhereNobodyMaySteer) {
  const auto shown = make({.port = 0, .control = false});
  shown->begin(run);
  TestViewer viewer(port(*shown));
  EXPECT_FALSE(state(viewer)["allowed"]);
  tell(viewer, Command::kEnd);
  EXPECT_FALSE(viewer.next());
  EXPECT_EQ(viewer.close_code(), 1008);
  EXPECT_TRUE(run->calls().empty());
}

TEST_F(Steered, NeedsTheTokenWhereThereIsOne) {
  const auto guarded = make({.port = 0, .token = "s3cret"});
  guarded->begin(run);
  EXPECT_THROW(TestViewer(port(*guarded), "/live?token=guess"), boost::system::system_error);
  TestViewer viewer(port(*guarded), "/live?token=s3cret");
  EXPECT_TRUE(state_after(viewer, Command::kEnd)["ending"]);
}

TEST_F(LiveView, CannotBeSteeredBeforeTheRunBegins) {
  TestViewer viewer(port(*output));
  viewer.send({static_cast<char>(kProtocol), 2, static_cast<char>(Command::kEnd)});
  output->frame(report_of(0));
  const auto records = viewer.asked();
  ASSERT_TRUE(records);
  ASSERT_TRUE(records->contains(Record::kSteering));
  EXPECT_FALSE(Json::parse(records->at(Record::kSteering).at(0))["allowed"]);
}

}  // namespace
}  // namespace stillpoint::output_web
