// Real people in a real recording, with a known truth: two who were photographed at a desk are cut
// out and wander through a recording without anybody, before and behind what is there.
#pragma once

#include <filesystem>

#include "people/maker.hpp"
#include "stillpoint/engine/pipeline_config.hpp"

namespace stillpoint::testing {

/// `photos`: the folder of the annotated TUM fr3 frames; `recording`: TUM's fr1_xyz, of which pairs
/// `first` … `first + count` are taken. The two cover up to a quarter of the picture.
inline people::Coverage paste_two_people(const std::filesystem::path& recording,
                                         const std::filesystem::path& photos, int first, int count,
                                         const std::filesystem::path& out) {
  const std::string photo = photos / "tum_1341846434.710184.png";
  const people::RecordingPlan plan{
      .name = "two",
      .first = first,
      .count = count,
      .people = {{.walk = {0, -0.6, 0.72, 3.5, 0.6, 0.72, 7, -0.6, 0.72},
                  .height = 0.5,
                  .elevation = 0.95,
                  .photo = photo,
                  .part = {40, 200, 210, 276}},
                 {.walk = {0, 0.5, 0.58, 2.5, -0.5, 0.58, 5, 0.5, 0.58},
                  .height = 0.45,
                  .elevation = 1.0,
                  .photo = photo,
                  .part = {345, 255, 260, 221}}}};
  const people::BaseRecording base(
      {.folder = recording}, load_camera(STILLPOINT_SOURCE_DIR "/configs/cameras/tum_fr1.yaml"));
  return people::make_recording(plan, base, {}, out, 2);
}

}  // namespace stillpoint::testing
