// The photographs that are for measuring: people and rooms that no network was trained with.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <vector>

#include "people/plans.hpp"

namespace stillpoint::people {

/// Every tenth image of a source, the first one among them, is for measuring; the training takes
/// the others. In order of name.
std::vector<std::filesystem::path> held_out_images(const std::filesystem::path& folder);

struct PersonPhoto {
  std::filesystem::path image;
  std::filesystem::path mask;
  double brightness = 0;  ///< median of the person, 0…255
};

/// Held-out photographs in `folders` with a mask (NAME.png) that shows one whole standing person.
std::vector<PersonPhoto> held_out_people(const std::vector<std::filesystem::path>& folders);

/// One photo for each plan that names none, each another person as long as there are enough.
std::vector<PersonPhoto> draw_people(const std::vector<PersonPhoto>& photos,
                                     const std::vector<PersonPlan>& plans, int seed);

/// Image and mask (CV_8UC1, 255 on the person). Throws Error(kData) naming the file.
struct MaskedPhoto {
  cv::Mat bgr;
  cv::Mat mask;
};
MaskedPhoto read_photo(const std::filesystem::path& image, const std::filesystem::path& mask);

}  // namespace stillpoint::people
