#include "output_web/map_changes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "output_web/test_reports.hpp"
#include "output_web/test_viewer.hpp"

namespace stillpoint::output_web {
namespace {

Records changes(const SparseMap& before, const SparseMap& after) {
  MessageWriter writer;
  writer.number(kProtocol);
  write_map_changes(before, after, writer);
  return records_of(writer.take());
}

TEST(MapChanges, OfAnEmptyMapAreAllOfIt) {
  Records records = changes({}, map_of_three());
  const std::string keyframes = records[Record::kKeyFrames].at(0);
  EXPECT_EQ(number_at<std::uint32_t>(keyframes, 0), 3u);
  // Id, presence, pose, frame and parent of the first, which has no edges to older ones.
  EXPECT_EQ(number_at<std::uint32_t>(keyframes, 4 + 4 + 1 + 28 + 8), 0u);
  const std::size_t second = 4 + 4 + 1 + 28 + 8 + 4;
  EXPECT_EQ(number_at<std::uint32_t>(keyframes, second), 1u);
  EXPECT_EQ(number_at<float>(keyframes, second + 5), 1.f);       // x
  EXPECT_EQ(number_at<float>(keyframes, second + 5 + 24), 1.f);  // w of no rotation
  EXPECT_EQ(number_at<std::uint32_t>(keyframes, second + 33), 10u);
  EXPECT_EQ(number_at<std::uint32_t>(keyframes, second + 41), 1u);  // one edge
  EXPECT_EQ(number_at<std::uint32_t>(keyframes, second + 45), 0u);  // to the first
  EXPECT_EQ(number_at<std::uint16_t>(keyframes, second + 49), 1u);  // by one landmark
  const std::string landmarks = records[Record::kLandmarks].at(0);
  ASSERT_EQ(number_at<std::uint32_t>(landmarks, 0), 2u);
  EXPECT_EQ(number_at<float>(landmarks, 4 + 4 + 8), 3.f);
  EXPECT_EQ(number_at<std::int8_t>(landmarks, 4 + 16), -8);
  EXPECT_EQ(number_at<std::uint8_t>(landmarks, 4 + 17), 3);
}

std::vector<std::uint32_t> counts(Records records) {
  return {number_at<std::uint32_t>(records[Record::kKeyFrames].at(0), 0),
          number_at<std::uint32_t>(records[Record::kLandmarks].at(0), 0)};
}

TEST(MapChanges, AreWhatHasChangedOnly) {
  const SparseMap before = map_of_three();
  EXPECT_THAT(counts(changes(before, before)), ::testing::ElementsAre(0, 0));

  MapEdit moved(before);
  moved.keyframe(1).world_from_camera.translation().y() = 2;
  moved.landmark(1).position_in_world.x() = 0;
  const SparseMap after = std::move(moved).finish();
  EXPECT_THAT(counts(changes(before, after)), ::testing::ElementsAre(1, 1));

  MapEdit evidence(before);
  ++evidence.landmark(0).visible;  // nobody sees this
  EXPECT_THAT(counts(changes(before, std::move(evidence).finish())), ::testing::ElementsAre(0, 0));
}

TEST(MapChanges, TellWhereARemovedKeyFrameStandsAndThatALandmarkIsGone) {
  const SparseMap before = map_of_three();
  MapEdit edit(before);
  edit.remove_keyframe(2);
  edit.remove_landmark(1);
  const SparseMap removed = std::move(edit).finish();
  Records records = changes(before, removed);
  const std::string& landmarks = records[Record::kLandmarks].at(0);
  EXPECT_EQ(number_at<std::uint8_t>(landmarks, landmarks.size() - 1), 0);  // observations
  const std::string& keyframes = records[Record::kKeyFrames].at(0);
  const std::size_t last = keyframes.size() - 33;
  EXPECT_EQ(number_at<std::uint32_t>(keyframes, last), 2u);
  EXPECT_EQ(number_at<std::uint8_t>(keyframes, last + 4), 0);
  EXPECT_EQ(number_at<float>(keyframes, last + 5), 2.f);

  MapEdit moving(removed);  // a removed one moves with its parent
  for (const KeyFrameId id : {0u, 1u}) moving.keyframe(id).world_from_camera.translation().y() = 7;
  records = changes(removed, std::move(moving).finish());
  const std::string& moved = records[Record::kKeyFrames].at(0);
  EXPECT_EQ(number_at<std::uint32_t>(moved, 0), 3u);
  EXPECT_EQ(number_at<float>(moved, moved.size() - 33 + 9), 7.f);
}

}  // namespace
}  // namespace stillpoint::output_web
