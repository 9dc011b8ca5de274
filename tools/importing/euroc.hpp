// Folders as the EuRoC data set has them (Burri et al., IJRR 2016), with depth images beside the
// colour ones, as RGB-D recorders write them: mav0/cam0 (or rgb0), mav0/depth0,
// mav0/state_groundtruth_estimate0.
#pragma once

#include <filesystem>
#include <memory>

#include "importing/foreign_recording.hpp"

namespace stillpoint::importing {

bool is_euroc(const std::filesystem::path& recording);

/// `recording` is the folder with mav0 in it, or mav0 itself. Depth must be registered to cam0;
/// without a camera of the user's, one unit is taken for a millimetre.
std::unique_ptr<ForeignRecording> open_euroc(const std::filesystem::path& recording,
                                             const ImportOptions& options);

}  // namespace stillpoint::importing
