// ICL-NUIM (Handa et al., ICRA 2014), its "TUM RGB-D compatible" images.
#pragma once

#include <filesystem>
#include <memory>

#include "importing/foreign_recording.hpp"

namespace stillpoint::importing {

constexpr double kIclNuimRate = 30;  ///< Hz; the data set has numbers instead of times

/// A pose of a camera and a world whose y points up, as one of a camera and a world whose y points
/// down.
Pose mirrored_in_y(const Pose& pose);

bool is_icl_nuim(const std::filesystem::path& recording);

/// Images stay as they are. The data set states fy = -480 for a world with y up; with fy = 480 its
/// poses are mirrored in the plane y = 0, so that they fit images whose y points down.
std::unique_ptr<ForeignRecording> open_icl_nuim(const std::filesystem::path& recording,
                                                const ImportOptions& options);

}  // namespace stillpoint::importing
