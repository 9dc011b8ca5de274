#include "output_web/voxels.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "output_web/fake_run.hpp"
#include "output_web/live_view_fixture.hpp"

namespace stillpoint::output_web {
namespace {

constexpr std::size_t kVoxelBytes = 17;

LabelledPoint voxel(float x, std::uint8_t label = 0) {
  return {.position = {x, 0, 0}, .rgb = {1, 2, 3}, .label = label};
}

/// Does what a viewer does with the records: x to label.
class Scene {
 public:
  void take(const Records& records) {
    if (const auto found = records.find(Record::kVoxels); found != records.end())
      for (const std::string& list : found->second)
        for (std::size_t at = 0; at < list.size(); at += kVoxelBytes)
          labels[number_at<float>(list, at)] = number_at<std::uint8_t>(list, at + 15);
    if (const auto found = records.find(Record::kVoxelsRemoved); found != records.end())
      for (const std::string& list : found->second)
        for (std::size_t at = 0; at < list.size(); at += 12)
          labels.erase(number_at<float>(list, at));
  }
  std::map<float, int> labels;
};

class VoxelChanges : public ::testing::Test {
 protected:
  /// Bytes of the message.
  std::size_t send(const VoxelsPtr& now, std::size_t limit = 100) {
    MessageWriter writer;
    writer.number(kProtocol);
    known = write_voxel_changes(known, now, limit, writer);
    const std::string message = writer.take();
    scene.take(records_of(message));
    return message.size();
  }

  VoxelsPtr known = std::make_shared<const Voxels>();
  Scene scene;
};

TEST_F(VoxelChanges, AreWhatHasChangedOnly) {
  send(sorted_voxels({voxel(2), voxel(1), voxel(3)}));
  EXPECT_EQ(scene.labels, (std::map<float, int>{{1, 0}, {2, 0}, {3, 0}}));
  const std::size_t header = 1 + 5;
  EXPECT_EQ(send(sorted_voxels({voxel(1), voxel(2), voxel(3)})), header);
  EXPECT_EQ(send(sorted_voxels({voxel(1), voxel(2, 7), voxel(4)})),
            header + 2 * kVoxelBytes + 5 + 12);
  EXPECT_EQ(scene.labels, (std::map<float, int>{{1, 0}, {2, 7}, {4, 0}}));
}

TEST_F(VoxelChanges, OfOccupancyAreSentFromAFifteenthOn) {
  LabelledPoint seen = voxel(1);
  seen.occupancy = 0.72F;
  send(sorted_voxels({seen}));
  const std::size_t header = 1 + 5;
  seen.occupancy = 0.73F;
  EXPECT_EQ(send(sorted_voxels({seen})), header);
  seen.occupancy = 0.8F;
  EXPECT_EQ(send(sorted_voxels({seen})), header + kVoxelBytes);
}

TEST(Voxels, LookAlikeUntilAViewerCouldSeeADifference) {
  LabelledPoint seen = voxel(1);
  seen.occupancy = 0.72F;
  const Voxels before = {seen, voxel(2)};
  Voxels now = before;
  now[0].occupancy = 0.73F;
  EXPECT_TRUE(look_alike(before, now));
  now[0].occupancy = 0.8F;
  EXPECT_FALSE(look_alike(before, now));
  EXPECT_FALSE(look_alike(before, {seen, voxel(3)}));
  EXPECT_FALSE(look_alike(before, {seen}));
}

TEST_F(VoxelChanges, ComeInPartsThatAddUp) {
  Voxels many, others;
  for (int i = 0; i < 25; ++i) {
    many.push_back(voxel(static_cast<float>(i)));
    if (i % 3 != 0) others.push_back(voxel(static_cast<float>(i), 2));
  }
  for (const Voxels& wanted : {many, others}) {
    const VoxelsPtr now = sorted_voxels(wanted);
    int parts = 0;
    while (known != now) {
      EXPECT_LE(send(now, 10), 1 + 5 + 10 * kVoxelBytes + 5);
      ASSERT_LT(++parts, 4);
    }
    EXPECT_EQ(parts, 3);
    EXPECT_EQ(scene.labels.size(), wanted.size());
    EXPECT_EQ(scene.labels.rbegin()->second, wanted.back().label);
  }
}

TEST_F(LiveView, ShowsTheDenseMapToWhoAsksForIt) {
  const auto run = std::make_shared<FakeRun>();
  run->dense = {voxel(1, 4)};
  output->begin(run);
  output->frame(report_of(0));
  TestViewer viewer(port(*output));
  auto records = viewer.asked(7);
  ASSERT_TRUE(records);
  EXPECT_FALSE(records->contains(Record::kVoxels));
  records = viewer.asked(15);
  ASSERT_TRUE(records);
  Scene scene;
  scene.take(*records);
  EXPECT_EQ(scene.labels, (std::map<float, int>{{1, 4}}));
}

// As while a run is paused.
TEST_F(LiveView, ShowsTheDenseMapThoughNothingElseIsNew) {
  const auto run = std::make_shared<FakeRun>();
  run->dense = {voxel(1, 4)};
  output->begin(run);
  output->frame(report_of(0));
  TestViewer viewer(port(*output));
  ASSERT_TRUE(viewer.asked(7));
  viewer.ask(7);
  viewer.ask(15);
  const auto records = viewer.next();
  ASSERT_TRUE(records);
  Scene scene;
  scene.take(*records);
  EXPECT_EQ(scene.labels, (std::map<float, int>{{1, 4}}));
}

TEST_F(LiveView, ReadsADenseMapAgainThatWasBusy) {
  const auto run = std::make_shared<FakeRun>();
  run->dense = {voxel(1, 4)};
  run->busy_reads = 2;
  output->begin(run);
  output->frame(report_of(0));
  TestViewer viewer(port(*output));
  ASSERT_TRUE(viewer.asked(15));
  const auto records = viewer.asked(15);
  ASSERT_TRUE(records);
  EXPECT_TRUE(records->contains(Record::kVoxels));
}

TEST_F(LiveView, ShowsTheRestWhileTheDenseMapIsBusy) {
  output->begin(std::make_shared<FakeRun>());
  output->frame(report_of(0));
  const auto records = TestViewer(port(*output)).asked(15);
  ASSERT_TRUE(records);
  EXPECT_FALSE(records->contains(Record::kVoxels));
  EXPECT_TRUE(records->contains(Record::kFrames));
}

}  // namespace
}  // namespace stillpoint::output_web
