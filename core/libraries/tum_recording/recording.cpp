#include "tum_recording/recording.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <utility>

#include "stillpoint/error.hpp"
#include "stillpoint/support/median.hpp"
#include "tum_recording/pairing.hpp"

namespace stillpoint::tum_recording {
namespace {

namespace fs = std::filesystem;

constexpr double kLongestInterval = 2.0;  // seconds between two images of a moving camera

fs::path find_associations(const fs::path& folder) {
  for (const char* name :
       {"associations.txt", "associate.txt", "associations", "association.txt", "associated.txt"})
    if (fs::is_regular_file(folder / name)) return folder / name;
  return {};
}

std::vector<double> stamps(const std::vector<StampedImage>& images) {
  std::vector<double> times;
  for (const StampedImage& image : images) times.push_back(image.time);
  return times;
}

std::string seconds(double time) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.3f", time);
  return text.data();
}

std::string range(const std::vector<StampedImage>& images) {
  if (images.empty()) return "none";
  return seconds(images.front().time) + " to " + seconds(images.back().time);
}

[[noreturn]] void throw_no_pair(const Recording& recording, double max_difference) {
  throw Error(Fault::kData,
              "no colour image has a depth image within " + seconds(max_difference) +
                  " s; colour images: " + range(recording.color) +
                  ", depth images: " + range(recording.depth),
              recording.folder.string(),
              "times are seconds on one clock; then max_difference or time_offset");
}

/// Drivers count milliseconds or nanoseconds.
void check_rate(Recording& recording) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < recording.pairs.size(); ++i)
    intervals.push_back(recording.pairs[i].color.time - recording.pairs[i - 1].color.time);
  const double interval = median(std::move(intervals));
  if (interval > kLongestInterval)
    recording.warnings.push_back(recording.folder.string() + ": images are " + seconds(interval) +
                                 " s apart; times are seconds, and these look like another unit");
}

void read_lists(Recording& recording, const RecordingOptions& options) {
  recording.color = read_image_list(recording.folder / "rgb.txt", recording.warnings);
  recording.depth = read_image_list(recording.folder / "depth.txt", recording.warnings);
  for (StampedImage& image : recording.depth) image.time += options.time_offset;
  for (const IndexPair& pair :
       pair_by_time(stamps(recording.color), stamps(recording.depth), options.max_difference))
    recording.pairs.push_back({recording.color[pair.color], recording.depth[pair.depth]});
  if (recording.pairs.empty()) throw_no_pair(recording, options.max_difference);
}

bool names_depth(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text.find("depth") != std::string::npos;
}

ImagePair parse_association(const ListLine& line, const fs::path& file) {
  if (line.columns.size() < 4)
    throw Error(Fault::kData,
                "found " + std::to_string(line.columns.size()) +
                    (line.columns.size() == 1 ? " column" : " columns"),
                file.string() + ":" + std::to_string(line.number),
                "expected a time stamp and a file name of each of the two images");
  StampedImage first{stamp_of(line, 0, file), file.parent_path() / line.columns[1]};
  StampedImage second{stamp_of(line, 2, file), file.parent_path() / line.columns[3]};
  const bool depth_first = names_depth(line.columns[1]) && !names_depth(line.columns[3]);
  return depth_first ? ImagePair{second, first} : ImagePair{first, second};
}

/// Orders pairs by colour time and drops those that use an image a second time.
void tidy(Recording& recording) {
  const std::string where = recording.pairs_from.string();
  auto& pairs = recording.pairs;
  const auto earlier = [](const ImagePair& a, const ImagePair& b) {
    return a.color.time < b.color.time;
  };
  if (!std::is_sorted(pairs.begin(), pairs.end(), earlier)) {
    std::stable_sort(pairs.begin(), pairs.end(), earlier);
    recording.warnings.push_back(where + ": time stamps are not in order; sorted");
  }
  const auto repeated =
      std::unique(pairs.begin(), pairs.end(), [](const ImagePair& a, const ImagePair& b) {
        return a.color.time == b.color.time || a.depth.file == b.depth.file;
      });
  if (repeated == pairs.end()) return;
  recording.warnings.push_back(where + ": " + std::to_string(pairs.end() - repeated) +
                               " repeated images; the first pair of each is used");
  pairs.erase(repeated, pairs.end());
}

void read_associations(Recording& recording) {
  for (const ListLine& line : read_list_lines(recording.pairs_from))
    recording.pairs.push_back(parse_association(line, recording.pairs_from));
  if (recording.pairs.empty())
    throw Error(Fault::kData, "lists no images", recording.pairs_from.string());
  tidy(recording);
  for (const ImagePair& pair : recording.pairs) {
    recording.color.push_back(pair.color);
    recording.depth.push_back(pair.depth);
  }
}

}  // namespace

Recording open_recording(const fs::path& folder, const RecordingOptions& options) {
  if (!fs::is_directory(folder))
    throw Error(Fault::kData, fs::exists(folder) ? "is not a folder" : "no such folder",
                folder.string(),
                "give the folder that holds rgb.txt and depth.txt, or a bag (.bag, .mcap, .db3)");
  Recording recording{.folder = folder};
  const bool has_rgb = fs::is_regular_file(folder / "rgb.txt");
  const bool has_depth = fs::is_regular_file(folder / "depth.txt");
  const fs::path associations = find_associations(folder);
  const bool has_lists = has_rgb && has_depth;
  if (!has_lists && associations.empty())
    throw Error(Fault::kData,
                has_rgb     ? "has rgb.txt but no depth.txt"
                : has_depth ? "has depth.txt but no rgb.txt"
                            : "has neither rgb.txt and depth.txt nor associations.txt",
                folder.string(),
                "a recording is a folder in the format of the TUM RGB-D benchmark, or a bag (.bag, "
                ".mcap, .db3); 'stillpoint import' converts other data sets");
  if (!associations.empty() && (!has_lists || options.prefer == PairsFrom::kAssociations)) {
    recording.pairs_from = associations;
    read_associations(recording);
  } else {
    read_lists(recording, options);
  }
  check_rate(recording);
  if (fs::is_regular_file(folder / "groundtruth.txt"))
    recording.ground_truth = folder / "groundtruth.txt";
  return recording;
}

}  // namespace stillpoint::tum_recording
