#include "orb_slam/orb_extractor.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <opencv2/imgproc.hpp>
#include <string>

#include "orb_slam/keypoint_distribution.hpp"
#include "orb_slam/orb_descriptor.hpp"
#include "stillpoint/error.hpp"

namespace stillpoint::orb_slam {
namespace {

constexpr int kPatchSize = 31;         // px, diameter of a keypoint on its level
constexpr int kThresholdCell = 32;     // px, where the lower threshold applies
constexpr double kDescriptorBlur = 2;  // px
const cv::Size kBlurWindow(7, 7);

// Geometric series: every level gets 1 / scale_factor of the features of the next finer level.
std::vector<int> share_features(const OrbOptions& options) {
  std::vector<int> shares;
  double weight_sum = 0;
  for (int level = 0; level < options.levels; ++level)
    weight_sum += std::pow(options.scale_factor, -level);
  double wanted = 0;
  int given = 0;
  for (int level = 0; level < options.levels; ++level) {
    wanted += options.features * std::pow(options.scale_factor, -level) / weight_sum;
    shares.push_back(static_cast<int>(std::lround(wanted)) - given);
    given += shares.back();
  }
  return shares;
}

// Moves the corners of a level where `fallback` is not zero.
void move_masked(std::vector<Corner>& corners, const cv::Mat& fallback, cv::Size level,
                 std::vector<Corner>& apart) {
  const auto is_spare = [&](const Corner& c) {
    return fallback.at<std::uint8_t>(c.y * fallback.rows / level.height,
                                     c.x * fallback.cols / level.width);
  };
  std::ranges::copy_if(corners, std::back_inserter(apart), is_spare);
  std::erase_if(corners, is_spare);
}

}  // namespace

void OrbOptions::visit(OptionVisitor& v) {
  v("features", features, {.min = 1, .max = 100000, .help = "ORB features wanted per image"});
  v("levels", levels, {.min = 1, .max = 16, .help = "levels of the scale pyramid"});
  v("scale_factor", scale_factor,
    {.min = 1.01, .max = 4, .help = "ratio of the image sizes of two neighbouring levels"});
  v("fast_threshold", fast_threshold,
    {.min = 1,
     .max = 254,
     .unit = "grey levels",
     .help = "FAST threshold: contrast of a corner; smaller: more corners, weaker ones"});
  v("fast_min_threshold", fast_min_threshold,
    {.min = 1,
     .max = 254,
     .unit = "grey levels",
     .help = "FAST threshold where fast_threshold finds no corner nearby"});
  v("oversampling", oversampling,
    {.min = 1,
     .max = 10,
     .help = "so many times the wanted corners are spread evenly over the image, and the strongest "
             "of them kept; 1: most even; larger: stronger corners, less evenly"});
  v("subpixel", subpixel, {.help = "refine corners to fractions of a pixel"});
  v.require(fast_min_threshold <= fast_threshold,
            "fast_min_threshold must not exceed fast_threshold");
}

OrbExtractor::OrbExtractor(const OrbOptions& options)
    : options_(options), features_per_level_(share_features(options)) {}

Features OrbExtractor::extract(const cv::Mat& gray, const cv::Mat& fallback, double share) {
  if (!gray.empty() && gray.type() != CV_8UC1)
    throw Error(Fault::kStage,
                "needs a gray image of 8 bits, got OpenCV type " + cv::typeToString(gray.type()),
                "orb extractor", "convert the image with cv::cvtColor");
  if (gray.cols > kMaxImageWidth)
    throw Error(Fault::kStage,
                "image is " + std::to_string(gray.cols) + " px wide, at most " +
                    std::to_string(kMaxImageWidth) + " are possible",
                "orb extractor", "scale the image down");
  Features features;
  features.scale_factor = options_.scale_factor;
  features.levels = options_.levels;
  build_pyramid(gray);
  for (std::size_t level = 0; level < pyramid_.size(); ++level) {
    detect(pyramid_[level], fallback, features_per_level_[level], share);
    describe(pyramid_[level], static_cast<int>(level), gray.size(), features);
  }
  return features;
}

// Levels that are smaller than a patch are left out.
void OrbExtractor::build_pyramid(const cv::Mat& gray) {
  const int smallest = 2 * kPatchBorder + 1;
  std::vector<cv::Mat> buffers = std::move(pyramid_);
  buffers.resize(static_cast<std::size_t>(options_.levels));
  pyramid_.clear();
  for (int level = 0; level < options_.levels; ++level) {
    const double scale = std::pow(options_.scale_factor, level);
    const cv::Size size(static_cast<int>(std::lround(gray.cols / scale)),
                        static_cast<int>(std::lround(gray.rows / scale)));
    if (size.width < smallest || size.height < smallest) return;
    if (level == 0) {
      pyramid_.push_back(gray);
      continue;
    }
    cv::Mat& image = buffers[static_cast<std::size_t>(level)];
    cv::resize(pyramid_.back(), image, size, 0, 0, cv::INTER_LINEAR);
    pyramid_.push_back(image);
  }
}

void OrbExtractor::detect(const cv::Mat& image, const cv::Mat& fallback, int count, double share) {
  fast_.detect(image, options_.fast_min_threshold, kPatchBorder, corners_);
  fallback_corners_.clear();
  if (!fallback.empty()) move_masked(corners_, fallback, image.size(), fallback_corners_);
  keep_best(corners_, image.size(), static_cast<int>(std::lround(share * count)));
  const int missing = count - static_cast<int>(corners_.size());
  if (missing <= 0 || fallback_corners_.empty()) return;
  keep_best(fallback_corners_, image.size(), missing);
  corners_.insert(corners_.end(), fallback_corners_.begin(), fallback_corners_.end());
}

void OrbExtractor::keep_best(std::vector<Corner>& corners, cv::Size image, int count) const {
  drop_weak_beside_strong(corners, image, kThresholdCell, options_.fast_threshold);
  const auto candidates = static_cast<int>(std::lround(options_.oversampling * count));
  keep_evenly_spread(corners, image, candidates);
  corners.resize(std::min(corners.size(), static_cast<std::size_t>(count)));
}

void OrbExtractor::describe(const cv::Mat& image, int level, cv::Size full_size,
                            Features& features) {
  if (corners_.empty()) return;
  cv::GaussianBlur(image, blurred_, kBlurWindow, kDescriptorBlur, kDescriptorBlur,
                   cv::BORDER_REFLECT_101);
  // Pixel centres, not corners, of two levels correspond: half a pixel is added and taken off.
  const double scale_x = static_cast<double>(full_size.width) / image.cols;
  const double scale_y = static_cast<double>(full_size.height) / image.rows;
  for (const Corner& corner : corners_) {
    const Direction direction = patch_direction(image, corner.x, corner.y);
    cv::Point2d point(corner.x, corner.y);
    if (options_.subpixel) point = refine_corner(image, corner);
    point = {(point.x + 0.5) * scale_x - 0.5, (point.y + 0.5) * scale_y - 0.5};
    features.keypoints.emplace_back(point, static_cast<float>(kPatchSize * scale_x),
                                    angle_degrees(direction), static_cast<float>(corner.score),
                                    level);
    features.descriptors.push_back(orb_descriptor(blurred_, corner.x, corner.y, direction));
  }
}

}  // namespace stillpoint::orb_slam
