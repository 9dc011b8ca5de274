// What viewers get.
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "output_web/live_view_fixture.hpp"

namespace stillpoint::output_web {
namespace {

TEST_F(LiveView, ShowsARunFromItsBeginning) {
  output->frame(report_of(0));
  output->frame(report_of(1));
  TestViewer viewer(port(*output));
  const auto records = viewer.asked();
  ASSERT_TRUE(records);
  const auto info = nlohmann::json::parse(records->at(Record::kRunInfo).at(0));
  EXPECT_EQ(info["camera"]["width"], 320);
  EXPECT_EQ(info["classes"][1]["name"], "person");
  EXPECT_EQ(records->at(Record::kStages).at(0).substr(1), "track");
  EXPECT_EQ(number_at<float>(records->at(Record::kTimes).at(0), 5), 5.f);
  const std::string& frames = records->at(Record::kFrames).at(0);
  ASSERT_EQ(frames.size() % 2, 0u);
  const std::size_t second = frames.size() / 2;
  EXPECT_EQ(number_at<std::uint32_t>(frames, second), 1u);
  EXPECT_DOUBLE_EQ(number_at<double>(frames, second + 4), recording().frame(1)->time);
  EXPECT_EQ(number_at<std::uint8_t>(frames, 13), 1);  // a key frame
  EXPECT_NEAR(number_at<float>(frames, second + 18),
              recording().world_from_camera(1).translation().x(), 1e-6);
  EXPECT_EQ(number_at<std::uint16_t>(frames, second + 18 + 56), 1000);
  EXPECT_EQ(number_at<std::uint32_t>(records->at(Record::kImage).at(0), 0), 1u);
  EXPECT_EQ(records->count(Record::kCloud), 1u);
  EXPECT_EQ(number_at<std::uint32_t>(records->at(Record::kLeftOut).at(0), 0), 2u);
}

TEST_F(LiveView, SendsWhatIsNewAndAskedFor) {
  output->frame(report_of(0));
  TestViewer viewer(port(*output));
  ASSERT_TRUE(viewer.asked(2));
  viewer.ask(2);
  output->frame(report_of(1));
  auto records = viewer.next();
  ASSERT_TRUE(records);
  EXPECT_EQ(number_at<std::uint32_t>(records->at(Record::kFrames).at(0), 0), 1u);
  for (const Record none : {Record::kRunInfo, Record::kStages, Record::kImage, Record::kCloud})
    EXPECT_FALSE(records->contains(none)) << static_cast<int>(none);
  records = viewer.asked(5);  // now the rest, without a new frame
  ASSERT_TRUE(records);
  EXPECT_TRUE(records->contains(Record::kCloud));
  EXPECT_FALSE(records->contains(Record::kFrames));
  EXPECT_FALSE(records->contains(Record::kLeftOut));
}

TEST_F(LiveView, AnswersTheLastOfSeveralRequests) {
  output->frame(report_of(0));
  TestViewer viewer(port(*output));
  ASSERT_TRUE(viewer.asked(2));
  viewer.ask(2);  // nothing of it is new
  viewer.ask(6);  // in its place
  const auto records = viewer.next();
  ASSERT_TRUE(records);
  EXPECT_TRUE(records->contains(Record::kCloud));
}

TEST_F(LiveView, TellsOfLoops) {
  FrameReport report = report_of(0);
  report.map = std::make_shared<const SparseMap>(map_of_three());
  output->frame(report);
  MapEdit edit(map_of_three());
  edit.keyframe(2).world_from_camera.translation().x() += 0.5;
  report = report_of(1);
  report.map = std::make_shared<const SparseMap>(std::move(edit).finish());
  report.loops_closed = 2;
  output->frame(report);
  TestViewer viewer(port(*output));
  const auto records = viewer.asked();
  ASSERT_TRUE(records);
  const std::string& loop = records->at(Record::kLoops).at(0);
  EXPECT_EQ(number_at<std::uint32_t>(loop, 0), 1u);
  EXPECT_EQ(number_at<std::uint32_t>(loop, 4), 1u);
  EXPECT_FLOAT_EQ(number_at<float>(loop, 8), 0.5f);
  EXPECT_EQ(number_at<std::uint32_t>(loop, 12), 2u);
}

TEST_F(LiveView, GivesALateViewerTheFramesInParts) {
  constexpr std::uint32_t kFrames = 1500;
  constexpr std::size_t kFrameSize = 92, kLargest = 64 << 10;  // bytes
  FrameReport report = report_of(1);
  for (std::uint32_t i = 0; i < kFrames; ++i) {
    auto frame = std::make_shared<Frame>(*report.frame);
    frame->index = i;
    report.frame = frame;
    output->frame(report);
  }
  finish(*output);
  TestViewer viewer(port(*output));
  std::uint32_t next = 0;
  std::size_t messages = 0;
  for (bool ended = false; !ended; ++messages) {
    const auto records = viewer.asked(2);
    ASSERT_TRUE(records);
    ended = records->contains(Record::kEnd);
    if (!records->contains(Record::kFrames)) continue;
    const std::string& frames = records->at(Record::kFrames).at(0);
    EXPECT_LE(frames.size(), kLargest);
    for (std::size_t at = 0; at < frames.size(); at += kFrameSize)
      EXPECT_EQ(number_at<std::uint32_t>(frames, at), next++);
  }
  EXPECT_EQ(next, kFrames);
  EXPECT_EQ(messages, 3u);
}

/// Of 1500 frames, a key frame each, 30,000 times, 20,002 landmarks and 50,000 voxels.
void write_long_run(EventLog& events) {
  MapEdit edit(map_of_three());
  for (int i = 0; i < 20'000; ++i) edit.add_landmark({.reference = 0});
  FrameReport report = report_of(0);
  report.map = std::make_shared<const SparseMap>(std::move(edit).finish());
  report.times = std::vector<StageTime>(20, report.times.front());
  for (std::uint32_t i = 0; i < 1500; ++i) {
    auto frame = std::make_shared<Frame>(*report.frame);
    frame->index = i;
    report.frame = frame;
    events.add(report);
  }
  std::vector<LabelledPoint> voxels(50'000);
  for (std::size_t i = 0; i < voxels.size(); ++i) voxels[i].position.x() = static_cast<float>(i);
  events.set_voxels(sorted_voxels(std::move(voxels)));
}

// Or a viewer with a slow connection would be taken for gone before it has the first one.
TEST(EventLog, GivesALongRunInMessagesThatAreNotLarge) {
  constexpr std::size_t kLargest = 650'000;  // bytes
  EventLog events({.name = "walk", .classes = testing::TestRecording::classes(), .truth = {}});
  write_long_run(events);
  Seen seen;
  std::map<Record, std::size_t> bytes;
  std::size_t landmarks = 0, clouds = 0;
  const Request all{.image = true, .map = true, .cloud = true, .voxels = true};
  for (std::string message; !(message = events.news(seen, all)).empty();) {
    EXPECT_LE(message.size(), kLargest);
    for (const auto& [kind, contents] : records_of(message))
      for (const std::string& content : contents) {
        bytes[kind] += content.size();
        if (kind == Record::kLandmarks) landmarks += number_at<std::uint32_t>(content, 0);
        if (kind == Record::kCloud) ++clouds;
      }
  }
  EXPECT_EQ(bytes[Record::kFrames], 1500u * 92);
  EXPECT_EQ(bytes[Record::kTimes], 12'000u * 9);  // so many are kept
  EXPECT_EQ(bytes[Record::kVoxels], 50'000u * 17);
  EXPECT_EQ(landmarks, 20'002u);
  EXPECT_EQ(clouds, 1500u);
}

TEST_F(LiveView, SaysHowTheRunHasEndedThenGoodBye) {
  output->frame(report_of(0));
  TestViewer viewer(port(*output)), late(port(*output));
  ASSERT_TRUE(viewer.asked());
  viewer.ask();
  finish(*output);
  const auto records = viewer.next();
  ASSERT_TRUE(records);
  const auto end_record = nlohmann::json::parse(records->at(Record::kEnd).at(0));
  EXPECT_TRUE(end_record["complete"]);
  EXPECT_EQ(end_record["source_skipped"], 3);
  std::thread end([&] { output.reset(); });
  EXPECT_FALSE(viewer.next());
  EXPECT_EQ(viewer.close_code(), 1001);
  const auto unasked = late.next();  // who has not asked gets it as well
  ASSERT_TRUE(unasked);
  EXPECT_TRUE(unasked->contains(Record::kEnd));
  EXPECT_FALSE(late.next());
  end.join();
}

}  // namespace
}  // namespace stillpoint::output_web
