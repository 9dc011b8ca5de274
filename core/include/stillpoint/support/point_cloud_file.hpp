// Point clouds with colours and classes, as files.
#pragma once

#include <filesystem>
#include <span>

#include "stillpoint/class_names.hpp"
#include "stillpoint/contracts/labelled_point.hpp"
#include "stillpoint/export.hpp"

namespace stillpoint {

/// Binary PLY: x, y, z (float), red, green, blue, label (uchar) per point; comments name the
/// classes. The file is whole or not there; throws Error(kUsage) when it cannot be written.
STILLPOINT_EXPORT void write_ply(std::span<const LabelledPoint> points, const ClassNames& classes,
                                 const std::filesystem::path& file);

}  // namespace stillpoint
