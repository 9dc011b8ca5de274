#include "output_web/map_changes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "output_web/test_reports.hpp"
#include "output_web/test_viewer.hpp"

namespace stillpoint::output_web {
namespace {

std::string next_message(SeenMap& seen, const MapPtr& now, std::size_t limit) {
  MessageWriter writer;
  writer.number(kProtocol);
  write_map_changes(seen, now, limit, writer);
  return writer.take();
}

Records changes(const SparseMap& before, const SparseMap& after) {
  constexpr std::size_t kAll = 1 << 20;  // bytes
  SeenMap seen{.whole = std::make_shared<const SparseMap>(before)};
  return records_of(next_message(seen, std::make_shared<const SparseMap>(after), kAll));
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

TEST(MapChanges, TellOnceThatTheMapWasCleared) {
  const SparseMap before = map_of_three();
  MapEdit edit(before);
  edit.clear();
  edit.add_keyframe({.id = 3,
                     .camera = std::make_shared<const Camera>(),
                     .features = std::make_shared<const Features>()});
  const SparseMap anew = std::move(edit).finish();
  for (const SparseMap& known : {before, SparseMap()}) {
    Records records = changes(known, anew);
    const std::string& keyframes = records[Record::kKeyFrames].at(0);
    ASSERT_EQ(number_at<std::uint32_t>(keyframes, 0), 4u);
    for (std::uint32_t id = 0; id < 3; ++id) {
      EXPECT_EQ(number_at<std::uint32_t>(keyframes, 4 + 33 * id), id);
      EXPECT_EQ(number_at<std::uint8_t>(keyframes, 4 + 33 * id + 4), 2);
    }
    EXPECT_EQ(number_at<std::uint8_t>(keyframes, 4 + 33 * 3 + 4), 1);
  }
  EXPECT_THAT(counts(changes(anew, anew)), ::testing::ElementsAre(0, 0));
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

using ById = std::map<std::uint32_t, float>;  // x of landmarks

ById landmarks_of(const SparseMap& map) {
  ById x;
  for (LandmarkId id = 0; id < map.landmark_id_end(); ++id)
    x[id] = static_cast<float>(map.landmark(id)->position_in_world.x());
  return x;
}

void take_landmarks(const std::string& part, ById& known) {
  constexpr std::size_t kLandmarkSize = 18;  // bytes
  const std::string list = records_of(part)[Record::kLandmarks].at(0);
  EXPECT_EQ(list.size(), 4 + kLandmarkSize * number_at<std::uint32_t>(list, 0));
  for (std::size_t at = 4; at < list.size(); at += kLandmarkSize)
    known[number_at<std::uint32_t>(list, at)] = number_at<float>(list, at + 4);
}

TEST(MapChanges, ComeInPartsOneVersionAfterTheOther) {
  MapEdit many(map_of_three());
  for (int i = 0; i < 100; ++i) many.add_landmark({.position_in_world = {7, 0, 0}, .reference = 0});
  const auto first = std::make_shared<const SparseMap>(std::move(many).finish());
  MapEdit moving(*first);
  for (LandmarkId id = 0; id < first->landmark_id_end(); ++id)
    moving.landmark(id).position_in_world.x() = id;
  const auto second = std::make_shared<const SparseMap>(std::move(moving).finish());

  constexpr std::size_t kLimit = 500, kHeaders = 1 + 2 * (5 + 4), kLargestElement = 60;  // bytes
  SeenMap seen;
  ById known;
  take_landmarks(next_message(seen, first, kLimit), known);
  EXPECT_LT(known.size(), 50u);
  for (const MapPtr& version : {first, second}) {
    for (int parts = 0; seen.whole != version; ++parts) {
      ASSERT_LT(parts, 10);
      const std::string part = next_message(seen, second, kLimit);
      EXPECT_LE(part.size(), kHeaders + kLimit + kLargestElement);
      take_landmarks(part, known);
    }
    EXPECT_EQ(known, landmarks_of(*version));
  }
}

}  // namespace
}  // namespace stillpoint::output_web
