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
  Study study = two_by_two(1);
  EXPECT_EQ(recording_of("/out", study, 0, 0), "/recordings/walking");
  study.sequences[0].dataset.clear();
  study.sequences[0].scene = "office";
  EXPECT_EQ(recording_of("/out", study, 0, 0), "/out/recordings/walking");
}

TEST(Matrix, SequencesWithTheSameImagesShareTheRecording) {
  Study study = two_by_two(2);
  study.new_noise = true;
  study.sequences = {{.name = "plain", .scene = "office"},
                     {.name = "other_camera", .scene = "office", .camera = "tum_fr3"},
                     {.name = "other_noise", .scene = "office", .set = {"depth.noise=0"}}};
  EXPECT_EQ(recording_of("/out", study, 1, 1), "/out/recordings/plain-8");
  EXPECT_EQ(recording_of("/out", study, 2, 1), "/out/recordings/other_noise-8");
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
  study.sequences[0] = sequence;
  EXPECT_EQ(recording_of("/out", study, 0, 2), "/out/recordings/room-12");
  EXPECT_EQ(at_repeat(study, study.sequences[1], 2).name, study.sequences[1].name)
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
