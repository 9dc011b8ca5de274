// One set of axes in a picture, drawn with OpenCV.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace stillpoint::evaluation {

namespace colour {  // BGR
inline const cv::Scalar kInk(60, 52, 45), kFaint(234, 230, 226), kReference(150, 143, 136),
    kEstimate(190, 98, 24);
}  // namespace colour

struct Range {
  double low, high;
  double span() const { return high - low; }
  void include(double value);
};

/// Text with its left (0), middle (0.5) or right end (1) at `anchor`, vertically centred on it.
void put_text(cv::Mat& picture, const std::string& text, cv::Point anchor, double size_px,
              double align, const cv::Scalar& colour = colour::kInk);

class Chart {
 public:
  /// `area`: the frame of the axes in pixels; labels lie outside to its left and below.
  Chart(cv::Mat& picture, cv::Rect area, Range x, Range y);

  /// Grid, numbers and titles; `x_title` empty: no numbers below either.
  void axes(const std::string& title, const std::string& x_title, const std::string& y_title);
  /// Lines between successive points; the next line begins wherever `breaks[i]` is set.
  void line(const std::vector<cv::Point2d>& points, const std::vector<bool>& breaks,
            const cv::Scalar& colour, int thickness);
  void segment(cv::Point2d from, cv::Point2d to, const cv::Scalar& colour, int thickness);
  void dot(cv::Point2d point, const cv::Scalar& colour, int radius);

 private:
  cv::Point pixel(cv::Point2d point) const;  // with kShift fractional bits

  cv::Mat& picture_;
  cv::Rect area_;
  Range x_, y_;
};

}  // namespace stillpoint::evaluation
