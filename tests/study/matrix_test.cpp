#include "study/matrix.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fixtures.hpp"

namespace stillpoint::study {
namespace {

using ::testing::ElementsAre;

TEST(Matrix, IsSequencesByVariantsByRepeats) {
  const Study study = two_by_two(2);
  EXPECT_THAT(cells_of(study),
              ElementsAre(Cell{0, 0, 0}, Cell{0, 0, 1}, Cell{0, 1, 0}, Cell{0, 1, 1}, Cell{1, 0, 0},
                          Cell{1, 0, 1}, Cell{1, 1, 0}, Cell{1, 1, 1}));
  EXPECT_EQ(name_of(study, {1, 1, 1}), "walking_empty/better/1");
  EXPECT_EQ(run_folder("/out", study, {0, 0, 1}), "/out/runs/walking/plain/1");
}

TEST(Matrix, OnlyAndSkipLeaveCellsOut) {
  Study study = two_by_two(1);
  study.variants[0].only = {"walking_empty"};
  study.variants[1].skip = {"walking_empty"};
  EXPECT_THAT(cells_of(study), ElementsAre(Cell{0, 1, 0}, Cell{1, 0, 0}));
}

TEST(Matrix, ARecordingLiesWhereItIsOrBelowTheOutput) {
  Sequence sequence = two_by_two(1).sequences[0];
  EXPECT_EQ(recording_of("/out", sequence), "/recordings/walking");
  sequence.dataset.clear();
  sequence.scene = "office";
  EXPECT_EQ(recording_of("/out", sequence), "/out/recordings/walking");
}

TEST(Matrix, ScenesHaveNewNoiseInEveryRepeatWhenAskedFor) {
  Study study = two_by_two(3);
  Sequence sequence{.name = "room", .scene = "office", .set = {"source.frames=5"}};
  EXPECT_EQ(at_repeat(study, sequence, 2).name, "room") << "one recording for all";
  study.new_noise = true;
  study.seed = 10;
  const Sequence third = at_repeat(study, sequence, 2);
  EXPECT_EQ(third.name, "room-12");
  EXPECT_THAT(third.set, ElementsAre("source.frames=5", "source.seed=12"));
  EXPECT_EQ(recording_of("/out", third), "/out/recordings/room-12");
  EXPECT_EQ(at_repeat(study, study.sequences[0], 2).name, study.sequences[0].name)
      << "a recording is what it is";
}

TEST(Matrix, ChangesOfAVariantComeLastAndWin) {
  Study study = two_by_two(1);
  study.mode = Study::Mode::kInline;
  study.set = {"tracker.features=1500"};
  EXPECT_THAT(assignments_of(study, study.variants[1]),
              ElementsAre("runtime.mode=inline", "tracker.features=1500", "tracker.features=2000"));
}

}  // namespace
}  // namespace stillpoint::study
