#include "tum_recording/stamp_list.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>

#include "stillpoint/error.hpp"
#include "stillpoint/support/input_file.hpp"

namespace stillpoint::tum_recording {
namespace {

std::vector<std::string> split(const std::string& line) {
  constexpr const char* kSeparators = " \t,\r";
  std::vector<std::string> columns;
  for (std::size_t end = 0;;) {
    const std::size_t begin = line.find_first_not_of(kSeparators, end);
    if (begin == std::string::npos) return columns;
    end = std::min(line.find_first_of(kSeparators, begin), line.size());
    columns.push_back(line.substr(begin, end - begin));
  }
}

void sort_by_time(std::vector<StampedImage>& images, const std::filesystem::path& file,
                  std::vector<std::string>& warnings) {
  const auto earlier = [](const StampedImage& a, const StampedImage& b) { return a.time < b.time; };
  if (!std::is_sorted(images.begin(), images.end(), earlier)) {
    std::stable_sort(images.begin(), images.end(), earlier);
    warnings.push_back(file.string() + ": time stamps are not in order; sorted");
  }
  const auto repeated =
      std::unique(images.begin(), images.end(),
                  [](const StampedImage& a, const StampedImage& b) { return a.time == b.time; });
  if (repeated == images.end()) return;
  warnings.push_back(file.string() + ": " + std::to_string(images.end() - repeated) +
                     " repeated time stamps; the first image of each is used");
  images.erase(repeated, images.end());
}

}  // namespace

std::vector<ListLine> read_list_lines(const std::filesystem::path& file) {
  input_file_size(file, kLargestText);
  std::ifstream stream(file);
  if (!stream) throw Error(Fault::kData, "cannot be opened", file.string());
  std::vector<ListLine> lines;
  std::string text;
  for (int number = 1; std::getline(stream, text); ++number) {
    ListLine line{number, split(text)};
    if (!line.columns.empty() && line.columns[0][0] != '#') lines.push_back(std::move(line));
  }
  return lines;
}

std::optional<double> parse_number(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

double stamp_of(const ListLine& line, std::size_t column, const std::filesystem::path& file) {
  if (const auto stamp = parse_number(line.columns[column])) return *stamp;
  throw Error(Fault::kData, "'" + line.columns[column] + "' is not a time stamp",
              file.string() + ":" + std::to_string(line.number),
              "expected seconds, such as 1305031102.175304");
}

std::vector<StampedImage> read_image_list(const std::filesystem::path& file,
                                          std::vector<std::string>& warnings) {
  std::vector<StampedImage> images;
  for (const ListLine& line : read_list_lines(file)) {
    if (line.columns.size() < 2)
      throw Error(Fault::kData, "found one column, '" + line.columns[0] + "'",
                  file.string() + ":" + std::to_string(line.number),
                  "expected a time stamp and a file name");
    images.push_back({stamp_of(line, 0, file), file.parent_path() / line.columns[1]});
  }
  if (images.empty())
    throw Error(Fault::kData, "lists no images", file.string(),
                "expected lines of a time stamp and a file name");
  sort_by_time(images, file, warnings);
  return images;
}

}  // namespace stillpoint::tum_recording
