#include "segmenter_opencv_dnn/box_mask.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "stillpoint/support/pixel_scale.hpp"

namespace stillpoint::segmenter_opencv_dnn {
namespace {

constexpr double kNoiseSigmas = 3.0;
constexpr float kClusterWidth = 1.15f;  // farthest over nearest depth of one surface
constexpr double kMinMeasured = 0.05;   // of the box's middle; with less, its depth is unknown
constexpr double kHalfGap = 3.0;        // px of 640 x 480: missing depth twice as wide is closed

std::vector<float> measured_in_middle(const cv::Mat& depth) {
  const cv::Rect middle(depth.cols / 4, depth.rows / 4, std::max(1, depth.cols / 2),
                        std::max(1, depth.rows / 2));
  std::vector<float> values;
  for (int v = middle.y; v < middle.br().y; ++v) {
    const auto* row = depth.ptr<float>(v);
    std::copy_if(row + middle.x, row + middle.br().x, std::back_inserter(values),
                 [](float z) { return z > 0; });
  }
  if (static_cast<double>(values.size()) < kMinMeasured * middle.area()) values.clear();
  return values;
}

/// The median depth of the nearest cluster with a share of the values; 0 when there is none.
float near_surface(std::vector<float> values, double share) {
  std::ranges::sort(values);
  const auto needed = std::max<std::size_t>(
      1, static_cast<std::size_t>(share * static_cast<double>(values.size())));
  for (std::size_t first = 0, end = 0; first < values.size(); ++first) {
    while (end < values.size() && values[end] <= values[first] * kClusterWidth) ++end;
    if (end - first >= needed) return values[(first + end) / 2];
  }
  return 0.0f;
}

/// Region growing from the seeds, over neighbouring pixels of similar depth.
class RegionGrowing {
 public:
  RegionGrowing(const cv::Mat& depth, double noise, float middle, const BoxMaskOptions& options)
      : depth_(depth),
        nearest_(middle - static_cast<float>(options.depth_extent)),
        farthest_(middle + static_cast<float>(options.depth_extent)),
        step_(static_cast<float>(options.depth_step)),
        step_by_noise_(static_cast<float>(kNoiseSigmas * noise)),
        mask_(depth.size(), CV_8UC1, cv::Scalar(0)) {}

  void seed(const cv::Point& pixel) {
    mask_.at<std::uint8_t>(pixel) = 255;
    open_.push_back(pixel);
  }

  cv::Mat grown() {
    while (!open_.empty()) {
      const cv::Point pixel = open_.back();
      open_.pop_back();
      for (const cv::Point& step : {cv::Point(1, 0), {-1, 0}, {0, 1}, {0, -1}})
        visit(pixel + step, depth_.at<float>(pixel));
    }
    return mask_;
  }

 private:
  void visit(const cv::Point& pixel, float from) {
    if (!cv::Rect({}, mask_.size()).contains(pixel) || mask_.at<std::uint8_t>(pixel)) return;
    const float z = depth_.at<float>(pixel);
    if (!(z > 0) || z < nearest_ || z > farthest_) return;
    if (std::abs(z - from) > step_ + step_by_noise_ * from * from) return;
    seed(pixel);
  }

  const cv::Mat& depth_;
  float nearest_;        // metres
  float farthest_;       // metres
  float step_;           // metres, besides noise
  float step_by_noise_;  // metres at 1 m
  cv::Mat mask_;
  std::vector<cv::Point> open_;
};

/// Of depth images as large as `image`.
cv::Mat close_gaps(const cv::Mat& mask, cv::Size image) {
  const int side = 2 * cvRound(kHalfGap * pixel_scale(image)) + 1;
  cv::Mat closed;
  cv::morphologyEx(mask, closed, cv::MORPH_CLOSE,
                   cv::getStructuringElement(cv::MORPH_ELLIPSE, {side, side}));
  return closed;
}

cv::Mat grow_surface(const cv::Mat& depth, cv::Size image, double noise, float middle,
                     const BoxMaskOptions& options) {
  RegionGrowing growing(depth, noise, middle, options);
  for (int v = depth.rows / 4; v < depth.rows - depth.rows / 4; ++v)
    for (int u = depth.cols / 4; u < depth.cols - depth.cols / 4; ++u) {
      const float z = depth.at<float>(v, u);
      if (z >= middle / kClusterWidth && z <= middle * kClusterWidth) growing.seed({u, v});
    }
  const cv::Mat grown = growing.grown();
  return grown | (close_gaps(grown, image) & ~(depth > 0));
}

cv::Mat ellipse(cv::Size size) {
  cv::Mat mask(size, CV_8UC1, cv::Scalar(0));
  const cv::Point2f centre((static_cast<float>(size.width) - 1) / 2,
                           (static_cast<float>(size.height) - 1) / 2);
  cv::ellipse(mask,
              {centre, {static_cast<float>(size.width), static_cast<float>(size.height)}, 0.0f},
              cv::Scalar(255), cv::FILLED);
  return mask;
}

}  // namespace

void BoxMaskOptions::visit(OptionVisitor& v) {
  v("overlap", overlap,
    {.min = 0,
     .max = 1,
     .help = "non-maximum suppression: of boxes of one class whose intersection over union is "
             "larger, only the best one counts"});
  v("depth_step", depth_step,
    {.min = 0,
     .unit = "m",
     .help = "depth difference of neighbouring pixels up to which the mask grows, besides noise; "
             "larger: the mask spreads to what is behind"});
  v("depth_extent", depth_extent,
    {.min = 0,
     .unit = "m",
     .help = "how far a mask reaches in depth, before and behind its object's median depth"});
  v("near_share", near_share,
    {.min = 0,
     .max = 1,
     .help = "the object in a box is the nearest surface that covers this share of the middle of "
             "the box; larger: what stands in front of it is passed over"});
}

cv::Mat box_mask(const cv::Mat& depth, double noise, const cv::Rect& box,
                 const BoxMaskOptions& options) {
  if (!depth.empty()) {
    const cv::Mat inside = depth(box);
    const float middle = near_surface(measured_in_middle(inside), options.near_share);
    if (middle > 0) return grow_surface(inside, depth.size(), noise, middle, options);
  }
  return ellipse(box.size());
}

}  // namespace stillpoint::segmenter_opencv_dnn
