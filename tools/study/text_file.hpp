// Small files, read and written as a whole.
#pragma once

#include <filesystem>
#include <string>

namespace stillpoint::study {

/// Empty when there is no such file. Throws Error(kData) as read_input_file() does.
std::string read_text(const std::filesystem::path& file);

/// The file is either complete or as it was before. Makes missing folders. Throws Error(kUsage).
void write_text(const std::filesystem::path& file, const std::string& text);

/// Makes the folder with its parents. Throws Error(kUsage).
void make_folder(const std::filesystem::path& folder);

/// With all that is in it. Throws Error(kUsage) when that cannot be done.
void remove_folder(const std::filesystem::path& folder);

}  // namespace stillpoint::study
