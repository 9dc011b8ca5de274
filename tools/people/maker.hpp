// Makes a recording with people out of one without.
#pragma once

#include <filesystem>

#include "people/cast.hpp"

namespace stillpoint::people {

/// Share of the image's pixels that people cover.
struct Coverage {
  int frames = 0;
  double mean = 0;
  double max = 0;
};

/// Writes rgb/, depth/, labels/ (of the undistorted images: those of the base, 15 where a person
/// is), instances/ (numbers of people and things), the lists and groundtruth.txt into `out`, which
/// appears when everything is in it. The same plan gives the same bytes, whatever `threads`.
Coverage make_recording(const RecordingPlan& plan, const BaseRecording& base,
                        const Sources& sources, const std::filesystem::path& out, int threads);

}  // namespace stillpoint::people
