// 7-Scenes (Shotton et al., CVPR 2013): frame-000000.color.png, .depth.png (mm) and .pose.txt.
#pragma once

#include <filesystem>
#include <memory>

#include "importing/foreign_recording.hpp"

namespace stillpoint::importing {

bool is_seven_scenes(const std::filesystem::path& recording);

/// Depth of the data set is not registered: it is moved from its own camera into that of the colour
/// images, unless the user names a camera.
std::unique_ptr<ForeignRecording> open_seven_scenes(const std::filesystem::path& recording,
                                                    const ImportOptions& options);

}  // namespace stillpoint::importing
