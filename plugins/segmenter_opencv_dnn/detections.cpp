#include "segmenter_opencv_dnn/detections.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "stillpoint/error.hpp"

namespace stillpoint::segmenter_opencv_dnn {
namespace {

constexpr int kSsdColumns = 7;
constexpr int kRegionScores = 5;  // first column with the score of a class

bool is_ssd(const cv::Mat& output) {
  return output.dims == 4 && output.size[0] == 1 && output.size[1] == 1 &&
         output.size[3] == kSsdColumns;
}

bool is_region(const cv::Mat& output, std::size_t classes) {
  return output.dims == 2 && output.cols == kRegionScores + static_cast<int>(classes) - 1;
}

void append_ssd(const cv::Mat& output, std::size_t classes, double threshold,
                std::vector<Detection>& found) {
  for (int i = 0; i < output.size[2]; ++i) {
    const float* row = output.ptr<float>(0, 0) + static_cast<std::ptrdiff_t>(i) * kSsdColumns;
    const int label = static_cast<int>(std::lround(row[1]));
    if (!(row[2] >= threshold) || label == 0) continue;
    if (label < 0 || label >= static_cast<int>(classes))
      throw Error(Fault::kData,
                  "the network found something of class " + std::to_string(label) +
                      ", but 'classes' has " + std::to_string(classes) + " names",
                  "", "give the class list of this network");
    found.push_back({label, row[2], {cv::Point2f(row[3], row[4]), cv::Point2f(row[5], row[6])}});
  }
}

void append_region(const cv::Mat& output, double threshold, std::vector<Detection>& found) {
  for (int i = 0; i < output.rows; ++i) {
    const float* row = output.ptr<float>(i);
    const float* best = std::max_element(row + kRegionScores, row + output.cols);
    if (!(*best >= threshold)) continue;
    const int label = static_cast<int>(best - (row + kRegionScores)) + 1;
    found.push_back({label, *best, {row[0] - row[2] / 2, row[1] - row[3] / 2, row[2], row[3]}});
  }
}

double intersection_over_union(const cv::Rect2f& a, const cv::Rect2f& b) {
  const double shared = (a & b).area();
  return shared > 0 ? shared / (a.area() + b.area() - shared) : 0.0;
}

}  // namespace

bool holds_boxes(const cv::Mat& output, std::size_t classes) {
  return output.depth() == CV_32F && (is_ssd(output) || is_region(output, classes));
}

std::vector<Detection> detections(const std::vector<cv::Mat>& outputs, std::size_t classes,
                                  double threshold, double overlap) {
  std::vector<Detection> found;
  for (const cv::Mat& output : outputs)
    if (is_ssd(output))
      append_ssd(output, classes, threshold, found);
    else
      append_region(output, threshold, found);
  std::ranges::stable_sort(found, std::greater{}, &Detection::score);
  std::vector<Detection> kept;
  for (const Detection& candidate : found)
    if (std::ranges::none_of(kept, [&](const Detection& better) {
          return better.label == candidate.label &&
                 intersection_over_union(better.box, candidate.box) > overlap;
        }))
      kept.push_back(candidate);
  return kept;
}

}  // namespace stillpoint::segmenter_opencv_dnn
