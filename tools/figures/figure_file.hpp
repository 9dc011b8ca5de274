// Figures as files.
#pragma once

#include <filesystem>
#include <string>

#include "figures/canvas.hpp"
#include "figures/figure.hpp"

namespace stillpoint::figures {

/// By its ending. Throws Error(kUsage), which names the three, for any other.
Format format_of(const std::filesystem::path& file);

/// The bytes of a file; the same figure gives the same bytes.
std::string draw(const Figure& figure, Format format);

/// The ending chooses the format. Makes missing folders. Throws Error as format_of(), or when the
/// file cannot be written; nothing is left behind then.
void write_figure(const Figure& figure, const std::filesystem::path& file);

}  // namespace stillpoint::figures
