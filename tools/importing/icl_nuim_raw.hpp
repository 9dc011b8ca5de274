// ICL-NUIM (Handa et al., ICRA 2014) as POV-Ray wrote it: scene_00_0000.png, .depth and .txt.
#pragma once

#include <filesystem>
#include <memory>

#include "importing/foreign_recording.hpp"

namespace stillpoint::importing {

bool is_icl_nuim_raw(const std::filesystem::path& recording);

/// Depth is along the rays there, in metres (scene_00_0000, the living room) or centimetres
/// (scene_000, the office); it becomes depth along the optical axis. Poses are mirrored as those of
/// open_icl_nuim.
std::unique_ptr<ForeignRecording> open_icl_nuim_raw(const std::filesystem::path& recording,
                                                    const ImportOptions& options);

}  // namespace stillpoint::importing
