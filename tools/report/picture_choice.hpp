// Which of a run's pictures a report shows.
#pragma once

#include <filesystem>

#include "report/report_data.hpp"

namespace stillpoint::report {

/// Of the folder `images`: some at even distances. Then the frames at which the run was worst
/// (lost, largest error, most excluded, fewest inliers), with the reason: as `images` shows them,
/// or else as they lie in the recording, where it is a folder of the TUM format, or else the
/// nearest one of `images`. Second and third worst ones only where `images` has them. By rising
/// frame.
void choose_pictures(RunData& run);

}  // namespace stillpoint::report
