#include "evaluation/chart.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "evaluation/format.hpp"

namespace stillpoint::evaluation {
namespace {

constexpr int kShift = 4;  // OpenCV draws at 1/16 pixel
constexpr double kTextSize = 26, kTitleSize = 30;
constexpr double kPixelsPerTick = 130;

// 1, 2 or 5 times a power of ten, for about `count` ticks.
double tick_step(const Range& range, double count) {
  const double rough = range.span() / std::max(count, 1.0);
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (double factor : {1.0, 2.0, 5.0})
    if (factor * power >= rough) return factor * power;
  return 10 * power;
}

std::vector<double> ticks(const Range& range, double step) {
  std::vector<double> result;
  for (double i = std::ceil(range.low / step); i * step <= range.high; ++i)
    result.push_back(i * step + 0.0);  // + 0.0: no "-0"
  return result;
}

int decimals(double step) {
  return std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
}

}  // namespace

void Range::include(double value) {
  low = std::min(low, value);
  high = std::max(high, value);
}

void put_text(cv::Mat& picture, const std::string& text, cv::Point anchor, double size_px,
              double align, const cv::Scalar& colour) {
  constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
  constexpr double kFontHeight = 29.5;  // pixels from top to descender at scale 1
  const double scale = size_px / kFontHeight;
  const int thickness = std::max(1, static_cast<int>(std::lround(size_px / 13)));
  const cv::Size size = cv::getTextSize(text, kFont, scale, thickness, nullptr);
  const cv::Point origin(anchor.x - static_cast<int>(align * size.width),
                         anchor.y + size.height / 2);
  cv::putText(picture, text, origin, kFont, scale, colour, thickness, cv::LINE_AA);
}

Chart::Chart(cv::Mat& picture, cv::Rect area, Range x, Range y)
    : picture_(picture), area_(area), x_(x), y_(y) {}

cv::Point Chart::pixel(cv::Point2d point) const {
  const double u = area_.x + (point.x - x_.low) / x_.span() * area_.width;
  const double v = area_.y + (y_.high - point.y) / y_.span() * area_.height;
  return {static_cast<int>(std::lround(u * (1 << kShift))),
          static_cast<int>(std::lround(v * (1 << kShift)))};
}

void Chart::axes(const std::string& title, const std::string& x_title, const std::string& y_title) {
  const double x_step = tick_step(x_, area_.width / kPixelsPerTick);
  const double y_step = tick_step(y_, area_.height / (0.6 * kPixelsPerTick));
  for (double x : ticks(x_, x_step)) {
    segment({x, y_.low}, {x, y_.high}, colour::kFaint, 2);
    const cv::Point below(pixel({x, 0}).x >> kShift, area_.br().y + 26);
    if (!x_title.empty()) put_text(picture_, fixed(x, decimals(x_step)), below, kTextSize, 0.5);
  }
  for (double y : ticks(y_, y_step)) {
    segment({x_.low, y}, {x_.high, y}, colour::kFaint, 2);
    const cv::Point left(area_.x - 14, pixel({0, y}).y >> kShift);
    put_text(picture_, fixed(y, decimals(y_step)), left, kTextSize, 1.0);
  }
  cv::rectangle(picture_, area_, colour::kReference, 2);
  put_text(picture_, title, {area_.x, area_.y - 28}, kTitleSize, 0.0);
  put_text(picture_, y_title, {area_.br().x, area_.y - 28}, kTextSize, 1.0);
  put_text(picture_, x_title, {area_.br().x, area_.br().y + 64}, kTextSize, 1.0);
}

void Chart::line(const std::vector<cv::Point2d>& points, const std::vector<bool>& breaks,
                 const cv::Scalar& colour, int thickness) {
  for (std::size_t i = 1; i < points.size(); ++i)
    if (!breaks[i]) segment(points[i - 1], points[i], colour, thickness);
}

void Chart::segment(cv::Point2d from, cv::Point2d to, const cv::Scalar& colour, int thickness) {
  cv::line(picture_, pixel(from), pixel(to), colour, thickness, cv::LINE_AA, kShift);
}

void Chart::dot(cv::Point2d point, const cv::Scalar& colour, int radius) {
  cv::circle(picture_, pixel(point), radius << kShift, colour, cv::FILLED, cv::LINE_AA, kShift);
}

}  // namespace stillpoint::evaluation
