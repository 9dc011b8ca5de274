// ScanNet (Dai et al., CVPR 2017): one .sens file.
#pragma once

#include <filesystem>
#include <memory>

#include "importing/foreign_recording.hpp"

namespace stillpoint::importing {

/// A .sens file, or a folder with one in it.
bool is_scannet(const std::filesystem::path& recording);

/// Colour images are scaled to the size of the depth images, and depth moves into the colour
/// camera.
std::unique_ptr<ForeignRecording> open_scannet(const std::filesystem::path& recording,
                                               const ImportOptions& options);

}  // namespace stillpoint::importing
