// The Bonn RGB-D Dynamic data set (Palazzolo et al., IROS 2019): the layout of the TUM benchmark,
// one camera.
#pragma once

#include <filesystem>
#include <memory>

#include "importing/foreign_recording.hpp"

namespace stillpoint::importing {

bool is_bonn(const std::filesystem::path& recording);

/// Images and depth stay as they are. The ground truth stays that of the marker that motion capture
/// saw, with which published figures are computed.
std::unique_ptr<ForeignRecording> open_bonn(const std::filesystem::path& recording,
                                            const ImportOptions& options);

}  // namespace stillpoint::importing
