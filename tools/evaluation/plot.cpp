#include "evaluation/plot.hpp"

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "evaluation/chart.hpp"
#include "evaluation/coverage.hpp"
#include "evaluation/format.hpp"
#include "stillpoint/error.hpp"

namespace stillpoint::evaluation {
namespace {

// Drawn at twice the size and scaled down: smoother than OpenCV's own lines and letters.
constexpr int kWidth = 2800, kHeight = 1600, kOversampling = 2;
const cv::Rect kFromAbove(150, 210, 1180, 820);
const cv::Rect kAxis[3] = {{1510, 210, 1190, 230}, {1510, 505, 1190, 230}, {1510, 800, 1190, 230}};
const cv::Rect kError(150, 1190, 2550, 290);
constexpr double kMargin = 0.06;  // of the range, free on either side
constexpr const char* kAxisName[3] = {"x", "y", "z"};

// What the charts show: the pairs, beside each other in the reference's world.
struct Paths {
  std::vector<double> seconds;  // since the reference began
  std::vector<Eigen::Vector3d> reference, estimate;
  std::vector<bool> breaks;  // a gap lies before this pair
};

Paths paths_of(const Evaluation& e) {
  const double longest = longest_interval(e.estimate);
  Paths paths;
  for (const auto& [r, i] : e.pairs) {
    const double seconds = e.reference.poses[r].time - e.reference.start();
    paths.breaks.push_back(!paths.seconds.empty() && seconds - paths.seconds.back() > longest);
    paths.seconds.push_back(seconds);
    paths.reference.push_back(e.reference.poses[r].world_from_camera.translation());
    paths.estimate.push_back(aligned(e.rigid.reference_from_estimate, e.estimate.poses[i]));
  }
  return paths;
}

Range with_margin(Range range) {
  const double margin = std::max(kMargin * range.span(), 0.005);
  return {range.low - margin, range.high + margin};
}

Range range_of_axis(const Paths& paths, int axis) {
  Range range{paths.reference[0][axis], paths.reference[0][axis]};
  for (const Eigen::Vector3d& p : paths.reference) range.include(p[axis]);
  for (const Eigen::Vector3d& p : paths.estimate) range.include(p[axis]);
  return with_margin(range);
}

// Widens one of the two so that a metre is as long along both.
void equalise(Range& x, Range& y, cv::Size pixels) {
  const double metres_per_pixel = std::max(x.span() / pixels.width, y.span() / pixels.height);
  const auto widen = [&](Range& range, int size) {
    const double missing = (metres_per_pixel * size - range.span()) / 2;
    range = {range.low - missing, range.high + missing};
  };
  widen(x, pixels.width);
  widen(y, pixels.height);
}

void draw_from_above(cv::Mat& picture, const Paths& paths) {
  Range x = range_of_axis(paths, 0), y = range_of_axis(paths, 1);
  equalise(x, y, kFromAbove.size());
  Chart chart(picture, kFromAbove, x, y);
  chart.axes("From above", "x [m]", "y [m]");
  const auto flat = [](const Eigen::Vector3d& p) { return cv::Point2d(p.x(), p.y()); };
  std::vector<cv::Point2d> reference, estimate;
  for (const Eigen::Vector3d& p : paths.reference) reference.push_back(flat(p));
  for (const Eigen::Vector3d& p : paths.estimate) estimate.push_back(flat(p));
  chart.line(reference, paths.breaks, colour::kReference, 9);
  chart.line(estimate, paths.breaks, colour::kEstimate, 4);
  chart.dot(reference.front(), colour::kInk, 12);
}

void draw_axis(cv::Mat& picture, const Paths& paths, int axis, Range time) {
  Chart chart(picture, kAxis[axis], time, range_of_axis(paths, axis));
  chart.axes(kAxisName[axis], axis == 2 ? "time [s]" : "", "[m]");
  std::vector<cv::Point2d> reference, estimate;
  for (std::size_t i = 0; i < paths.seconds.size(); ++i) {
    reference.emplace_back(paths.seconds[i], paths.reference[i][axis]);
    estimate.emplace_back(paths.seconds[i], paths.estimate[i][axis]);
  }
  chart.line(reference, paths.breaks, colour::kReference, 9);
  chart.line(estimate, paths.breaks, colour::kEstimate, 4);
}

void draw_error(cv::Mat& picture, const Evaluation& e, const Paths& paths, Range time) {
  constexpr double kMillimetres = 1000;
  const double rmse = kMillimetres * e.rigid.metres.rmse;
  Chart chart(picture, kError, time, {0, std::max(1.1 * kMillimetres * e.rigid.metres.max, 1e-3)});
  chart.axes("Absolute error over time, RMSE " + fixed(rmse, 1) + " mm dashed", "time [s]", "[mm]");
  std::vector<cv::Point2d> error;
  for (std::size_t i = 0; i < paths.seconds.size(); ++i)
    error.emplace_back(paths.seconds[i], kMillimetres * e.rigid.per_pair[i]);
  chart.line(error, paths.breaks, colour::kEstimate, 4);
  constexpr int kDashes = 80;
  const double dash = time.span() / (2 * kDashes);
  for (int i = 0; i < kDashes; ++i)
    chart.segment({time.low + 2 * i * dash, rmse}, {time.low + (2 * i + 1) * dash, rmse},
                  colour::kInk, 3);
}

void draw_heading(cv::Mat& picture, const Evaluation& e) {
  const std::string name = std::filesystem::path(e.estimate.name).filename().string();
  put_text(picture, name, {kFromAbove.x, 60}, 46, 0.0);
  const std::string figures = "ATE RMSE " + fixed(1000 * e.rigid.metres.rmse, 1) + " mm, " +
                              std::to_string(e.pairs.size()) + " poses";
  put_text(picture, figures, {kFromAbove.x, 122}, 30, 0.0);
  const auto legend = [&](int x, const std::string& text, const cv::Scalar& c, int thickness) {
    cv::line(picture, {x, 60}, {x + 90, 60}, c, thickness, cv::LINE_AA);
    put_text(picture, text, {x + 110, 60}, 30, 0.0);
  };
  legend(2060, "reference", colour::kReference, 9);
  legend(2420, "estimate", colour::kEstimate, 4);
}

}  // namespace

cv::Mat draw_plot(const Evaluation& e) {
  const Paths paths = paths_of(e);
  const Range time{paths.seconds.front(), paths.seconds.back()};
  cv::Mat picture(kHeight, kWidth, CV_8UC3, cv::Scalar::all(255));
  draw_heading(picture, e);
  draw_from_above(picture, paths);
  for (int axis = 0; axis < 3; ++axis) draw_axis(picture, paths, axis, time);
  draw_error(picture, e, paths, time);
  cv::Mat result;
  cv::resize(picture, result, {}, 1.0 / kOversampling, 1.0 / kOversampling, cv::INTER_AREA);
  return result;
}

void write_plot(const Evaluation& evaluation, const std::filesystem::path& png) {
  const cv::Mat plot = draw_plot(evaluation);
  bool written = false;
  try {
    written = cv::imwrite(png.string(), plot);
  } catch (const cv::Exception&) {  // the ending names no image format
  }
  if (!written)
    throw Error(Fault::kUsage, "the plot cannot be written", png.string(),
                "name a .png file in a folder that exists");
}

}  // namespace stillpoint::evaluation
