#include "people/photographs.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "stillpoint/error.hpp"
#include "stillpoint/support/image_codec.hpp"
#include "stillpoint/support/image_file.hpp"

namespace stillpoint::people {
namespace {

namespace fs = std::filesystem;

constexpr int kHeldOut = 10;        // one image in so many
constexpr int kSmallest = 250;      // px, height of a person
constexpr double kSlender = 1.7;    // height by width: standing
constexpr double kOnePiece = 0.97;  // share of the largest connected part
constexpr double kDark = 50;        // brightness
constexpr double kBright = 95;

/// The mask without its crumbs, when it shows one whole standing person.
bool shows_one_person(const cv::Mat& mask) {
  cv::Mat labels, statistics, centres;
  const int parts = cv::connectedComponentsWithStats(mask, labels, statistics, centres);
  int largest = 0, all = 0;
  for (int i = 1; i < parts; ++i) {
    largest = std::max(largest, statistics.at<int>(i, cv::CC_STAT_AREA));
    all += statistics.at<int>(i, cv::CC_STAT_AREA);
  }
  if (all == 0 || largest < kOnePiece * all) return false;
  const cv::Rect box = cv::boundingRect(mask);
  const bool whole =
      box.y > 1 && box.br().y < mask.rows - 1 && box.x > 1 && box.br().x < mask.cols - 1;
  return whole && box.height >= kSmallest && box.height >= kSlender * box.width;
}

double median_of(const cv::Mat& bgr, const cv::Mat& mask) {
  cv::Mat gray;
  cv::cvtColor(bgr, gray, cv::COLOR_BGR2GRAY);
  std::vector<std::uint8_t> values;
  for (int y = 0; y < gray.rows; ++y)
    for (int x = 0; x < gray.cols; ++x)
      if (mask.at<std::uint8_t>(y, x)) values.push_back(gray.at<std::uint8_t>(y, x));
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

bool wears(const PersonPhoto& photo, PersonPlan::Clothes clothes) {
  if (clothes == PersonPlan::Clothes::kDark) return photo.brightness < kDark;
  if (clothes == PersonPlan::Clothes::kBright) return photo.brightness > kBright;
  return true;
}

}  // namespace

std::vector<fs::path> held_out_images(const fs::path& folder) {
  std::error_code error;
  fs::directory_iterator files(folder, error);
  if (error)
    throw Error(Fault::kData, "cannot read the folder of photographs (" + error.message() + ")",
                folder.string(), "unpack the images there");
  std::vector<fs::path> images;
  for (const fs::directory_entry& entry : files)
    if (entry.path().extension() == ".webp") images.push_back(entry.path());
  std::ranges::sort(images);
  std::vector<fs::path> held_out;
  for (std::size_t i = 0; i < images.size(); i += kHeldOut) held_out.push_back(images[i]);
  return held_out;
}

MaskedPhoto read_photo(const fs::path& image, const fs::path& mask) {
  MaskedPhoto photo{.bgr = decode_image(read_image_file(image), cv::IMREAD_COLOR),
                    .mask = decode_image(read_image_file(mask), cv::IMREAD_GRAYSCALE)};
  if (photo.bgr.empty() || photo.mask.empty() || photo.bgr.size() != photo.mask.size())
    throw Error(Fault::kData, "cannot be read, or its mask has another size", image.string(),
                "expected the mask in " + mask.filename().string());
  photo.mask = photo.mask == 255;
  return photo;
}

std::vector<PersonPhoto> held_out_people(const std::vector<fs::path>& folders) {
  std::vector<PersonPhoto> people;
  for (const fs::path& folder : folders) {
    for (const fs::path& image : held_out_images(folder)) {
      const fs::path mask = fs::path(image).replace_extension(".png");
      if (!fs::exists(mask)) continue;
      const MaskedPhoto photo = read_photo(image, mask);
      if (shows_one_person(photo.mask))
        people.push_back({image, mask, median_of(photo.bgr, photo.mask)});
    }
  }
  return people;
}

std::vector<PersonPhoto> draw_people(const std::vector<PersonPhoto>& photos,
                                     const std::vector<PersonPlan>& plans, int seed) {
  cv::RNG random(static_cast<std::uint64_t>(seed) * 104729 + 11);
  std::vector<PersonPhoto> left = photos, drawn;
  for (const PersonPlan& plan : plans) {
    if (!plan.photo.empty()) continue;
    std::vector<std::size_t> fit;
    for (std::size_t i = 0; i < left.size(); ++i)
      if (wears(left[i], plan.clothes)) fit.push_back(i);
    if (fit.empty())
      throw Error(Fault::kData, "there are too few held-out people with such clothes", "",
                  "name folders with more photographs");
    const std::size_t chosen =
        fit[static_cast<std::size_t>(random.uniform(0, static_cast<int>(fit.size())))];
    drawn.push_back(left[chosen]);
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(chosen));
  }
  return drawn;
}

}  // namespace stillpoint::people
