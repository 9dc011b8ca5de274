#include "moving_checks/corners.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace stillpoint::moving_checks {
namespace {

constexpr int kBlock = 3;  // px, in which a corner's gradients are summed

// The strongest corner of every cell of an image of scores.
class CornerGrid {
 public:
  CornerGrid(const cv::Mat& half, int cells, int border)
      : border_(border),
        side_(std::max(2.0, std::sqrt(static_cast<double>(half.total()) / cells))),
        columns_(static_cast<int>(half.cols / side_) + 1),
        rows_(static_cast<int>(half.rows / side_) + 1),
        taken_(static_cast<std::size_t>(columns_) * rows_, false),
        best_(taken_.size()) {
    cv::cornerMinEigenVal(half, scores_, kBlock);
    for (int y = border_; y < scores_.rows - border_; ++y) scan_row(y);
  }

  void accept(std::span<const cv::Point2f> kept, double min_gradient, Corners& corners) {
    // cv::cornerMinEigenVal scales gradients to [0, 1] and averages their squares.
    const auto threshold = static_cast<float>(min_gradient * min_gradient / (255.0 * 255.0));
    for (std::size_t i = 0; i < kept.size(); ++i) {
      const cv::Point at(cvRound(kept[i].x / 2), cvRound(kept[i].y / 2));
      if (!inside(at)) continue;
      const std::size_t cell = cell_of(at.x, at.y);
      if (taken_[cell] || score_around(at) <= threshold) continue;
      taken_[cell] = true;
      corners.points.push_back(kept[i]);
      corners.kept_index.push_back(static_cast<int>(i));
    }
    for (std::size_t cell = 0; cell < best_.size(); ++cell) {
      if (taken_[cell] || best_[cell].score <= threshold) continue;
      corners.points.emplace_back(2.0f * best_[cell].at.x, 2.0f * best_[cell].at.y);
      corners.kept_index.push_back(-1);
    }
  }

 private:
  struct Best {
    float score = 0;
    cv::Point at;
  };

  void scan_row(int y) {
    const float* row = scores_.ptr<float>(y);
    for (int x = border_; x < scores_.cols - border_; ++x) {
      Best& best = best_[cell_of(x, y)];
      if (row[x] > best.score) best = {row[x], {x, y}};
    }
  }

  std::size_t cell_of(int x, int y) const {
    return static_cast<std::size_t>(y / side_) * columns_ + static_cast<std::size_t>(x / side_);
  }
  bool inside(const cv::Point& at) const {
    return at.x >= border_ && at.y >= border_ && at.x < scores_.cols - border_ &&
           at.y < scores_.rows - border_;
  }
  float score_around(const cv::Point& at) const {
    float score = 0;
    for (int y = at.y - 1; y <= at.y + 1; ++y)
      for (int x = at.x - 1; x <= at.x + 1; ++x) score = std::max(score, scores_.at<float>(y, x));
    return score;
  }

  int border_;
  double side_;  // px of a cell
  int columns_, rows_;
  std::vector<bool> taken_;
  std::vector<Best> best_;
  cv::Mat scores_;
};

Corners strongest_corners(const cv::Mat& gray, const CornerOptions& options) {
  Corners corners;
  cv::goodFeaturesToTrack(gray, corners.points, options.max_corners, options.corner_quality,
                          options.min_distance, cv::noArray(), kBlock);
  corners.kept_index.assign(corners.points.size(), -1);
  return corners;
}

}  // namespace

void CornerOptions::visit(OptionVisitor& v) {
  v.choice("corners", corners, {{"grid", Method::kGrid}, {"shi_tomasi", Method::kShiTomasi}},
           {.help = "P1 of Algorithm 1: the strongest corner of every cell, or the strongest ones "
                    "anywhere"});
  v("max_corners", max_corners,
    {.min = 8,
     .max = 100000,
     .help =
         "corners followed from the previous frame, P1 of Algorithm 1; for grid: about so many"});
  v("min_gradient", min_gradient,
    {.min = 0,
     .max = 255,
     .unit = "grey levels/px",
     .help = "for grid: least gradient in every direction, in the image at half its size"});
  v("corner_quality", corner_quality,
    {.min = 1e-6,
     .max = 1,
     .help = "for shi_tomasi: least score, as a share of the strongest one"});
  v("min_distance", min_distance,
    {.min = 0, .unit = "px", .help = "for shi_tomasi: least distance of two corners"});
}

Corners find_corners(const cv::Mat& gray, const cv::Mat& half, std::span<const cv::Point2f> kept,
                     double border, const CornerOptions& options) {
  if (options.corners == CornerOptions::Method::kShiTomasi) return strongest_corners(gray, options);
  Corners corners;
  const int half_border = std::max(1, static_cast<int>(std::ceil(border / 2)));
  CornerGrid(half, options.max_corners, half_border).accept(kept, options.min_gradient, corners);
  return corners;
}

}  // namespace stillpoint::moving_checks
