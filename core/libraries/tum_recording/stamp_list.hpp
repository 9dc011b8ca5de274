// The text files of a TUM recording: a time stamp and more columns per line, # for comments.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace stillpoint::tum_recording {

/// An image and when it was taken.
struct StampedImage {
  double time = 0.0;  ///< seconds
  std::filesystem::path file;
};

/// One line of a list that is no comment.
struct ListLine {
  int number = 0;  ///< from 1
  std::vector<std::string> columns;
};

/// Lines with their columns, which spaces, tabs or commas separate. Throws Error(kData) when the
/// file cannot be read.
std::vector<ListLine> read_list_lines(const std::filesystem::path& file);

/// A finite number of seconds, or nothing.
std::optional<double> parse_number(std::string_view text);

/// The stamp in column `column` of a line; throws Error(kData) with file and line.
double stamp_of(const ListLine& line, std::size_t column, const std::filesystem::path& file);

/// rgb.txt or depth.txt: time stamp and file name, the latter relative to the list's folder. The
/// result is sorted, of equal stamps the first is kept; both are told in `warnings`. Throws
/// Error(kData) when the list is missing, empty or has a line that cannot be understood.
std::vector<StampedImage> read_image_list(const std::filesystem::path& file,
                                          std::vector<std::string>& warnings);

}  // namespace stillpoint::tum_recording
