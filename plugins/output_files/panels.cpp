#include "output_files/panels.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <string>

#include "output_files/annotation.hpp"

namespace stillpoint::output_files {
namespace {

constexpr AnnotationParts kNothing{
    .features = false, .moving = false, .mask = false, .evidence = false, .text = false};

void put_line(cv::Mat& picture, const std::string& text, cv::Point at) {
  const double scale = std::max(0.35, picture.rows / 900.0);
  cv::putText(picture, text, at, cv::FONT_HERSHEY_SIMPLEX, scale, cv::Scalar::all(0), 3,
              cv::LINE_AA);
  cv::putText(picture, text, at, cv::FONT_HERSHEY_SIMPLEX, scale, cv::Scalar::all(255), 1,
              cv::LINE_AA);
}

void put_title(cv::Mat& picture, const std::string& text) {
  put_line(picture, text, {6, std::max(12, picture.rows / 24)});
}

/// Why an object's pixels are used or not: it moves, or stands still.
void draw_decisions(cv::Mat& picture, const FrameReport& report) {
  const std::vector<bool>& moves = report.weights->object_moves;
  const auto& objects = report.segmentation->objects;
  for (std::size_t i = 0; i < std::min(objects.size(), moves.size()); ++i)
    put_line(picture, moves[i] ? "moves" : "still",
             (objects[i].box.tl() + objects[i].box.br()) / 2 - cv::Point(picture.cols / 32, 0));
}

/// What tracking does not use is dark, as much as its weight is low.
void darken_excluded(cv::Mat& picture, const cv::Mat& weights) {
  if (weights.size() != picture.size()) return;
  cv::Mat factor;
  cv::cvtColor(weights, factor, cv::COLOR_GRAY2BGR);
  factor.convertTo(factor, CV_8UC3, 0.85, 0.15 * 255);
  cv::multiply(picture, factor, picture, 1.0 / 255.0);
}

std::string moving_title(const MovingPoints& moving) {
  if (!moving.reliable) return "moving points: none known";
  return std::to_string(std::ranges::count_if(moving.points, &PointMotion::moving)) + " of " +
         std::to_string(moving.points.size()) + " points move";
}

}  // namespace

cv::Mat panels_of(const FrameReport& report) {
  AnnotationParts features = kNothing, moving = kNothing, labels = kNothing;
  features.features = features.text = moving.moving = labels.mask = true;
  cv::Mat panels[4] = {annotated(report, features), annotated(report, moving),
                       annotated(report, labels), annotated(report, kNothing)};
  put_title(panels[0], "features");
  put_title(panels[1], moving_title(report.moving));
  put_title(panels[2], "labels");
  draw_decisions(panels[2], report);
  darken_excluded(panels[3], report.weights->track);
  put_title(panels[3], "used by tracking");
  cv::Mat above, below, all;
  cv::hconcat(panels[0], panels[1], above);
  cv::hconcat(panels[2], panels[3], below);
  cv::vconcat(above, below, all);
  return all;
}

}  // namespace stillpoint::output_files
