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

const cv::Scalar kRunColours[] = {colour::kEstimate, {40, 110, 216}, {80, 145, 40}, {160, 70, 150},
                                  {150, 150, 0},     {60, 60, 190},  {20, 170, 200}};  // BGR

// What the charts show of a run: its pairs, beside each other in the reference's world.
struct Path {
  std::vector<double> seconds;  // since the reference began
  std::vector<Eigen::Vector3d> reference, estimate;
  std::vector<bool> breaks;   // a gap lies before this pair
  std::vector<double> error;  // metres
  cv::Scalar colour;
};

Path path_of(const PlottedRun& run, const cv::Scalar& colour) {
  const Evaluation& e = run.evaluation;
  const double longest = longest_interval(e.estimate);
  Path path;
  path.colour = colour;
  path.error = run.error.per_pair;
  for (const auto& [r, i] : e.pairs) {
    const double seconds = e.reference.poses[r].time - e.reference.start();
    path.breaks.push_back(!path.seconds.empty() && seconds - path.seconds.back() > longest);
    path.seconds.push_back(seconds);
    path.reference.push_back(e.reference.poses[r].world_from_camera.translation());
    path.estimate.push_back(aligned(run.error.reference_from_estimate, e.estimate.poses[i]));
  }
  return path;
}

/// The one that shows most of the reference.
const Path& longest_of(const std::vector<Path>& paths) {
  return *std::ranges::max_element(paths, {}, [](const Path& path) { return path.seconds.size(); });
}

Range with_margin(Range range) {
  const double margin = std::max(kMargin * range.span(), 0.005);
  return {range.low - margin, range.high + margin};
}

Range range_of_axis(const std::vector<Path>& paths, int axis) {
  Range range{paths[0].reference[0][axis], paths[0].reference[0][axis]};
  for (const Path& path : paths) {
    for (const Eigen::Vector3d& p : path.reference) range.include(p[axis]);
    for (const Eigen::Vector3d& p : path.estimate) range.include(p[axis]);
  }
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

std::vector<cv::Point2d> flat(const std::vector<Eigen::Vector3d>& points) {
  std::vector<cv::Point2d> result;
  for (const Eigen::Vector3d& p : points) result.emplace_back(p.x(), p.y());
  return result;
}

void draw_from_above(cv::Mat& picture, const std::vector<Path>& paths) {
  Range x = range_of_axis(paths, 0), y = range_of_axis(paths, 1);
  equalise(x, y, kFromAbove.size());
  Chart chart(picture, kFromAbove, x, y);
  chart.axes("From above", "x [m]", "y [m]");
  const Path& longest = longest_of(paths);
  const std::vector<cv::Point2d> reference = flat(longest.reference);
  chart.line(reference, longest.breaks, colour::kReference, 9);
  for (const Path& path : paths) chart.line(flat(path.estimate), path.breaks, path.colour, 4);
  chart.dot(reference.front(), colour::kInk, 12);
}

std::vector<cv::Point2d> over_time(const Path& path, const std::vector<Eigen::Vector3d>& points,
                                   int axis) {
  std::vector<cv::Point2d> result;
  for (std::size_t i = 0; i < points.size(); ++i)
    result.emplace_back(path.seconds[i], points[i][axis]);
  return result;
}

void draw_axis(cv::Mat& picture, const std::vector<Path>& paths, int axis, Range time) {
  Chart chart(picture, kAxis[axis], time, range_of_axis(paths, axis));
  chart.axes(kAxisName[axis], axis == 2 ? "time [s]" : "", "[m]");
  const Path& longest = longest_of(paths);
  chart.line(over_time(longest, longest.reference, axis), longest.breaks, colour::kReference, 9);
  for (const Path& path : paths)
    chart.line(over_time(path, path.estimate, axis), path.breaks, path.colour, 4);
}

void draw_error(cv::Mat& picture, std::span<const PlottedRun> runs, const std::vector<Path>& paths,
                Range time) {
  constexpr double kMillimetres = 1000;
  double largest = 0.0;
  for (const PlottedRun& run : runs) largest = std::max(largest, run.error.metres.max);
  Chart chart(picture, kError, time, {0, std::max(1.1 * kMillimetres * largest, 1e-3)});
  chart.axes("Absolute error over time, RMSE dashed", "time [s]", "[mm]");
  constexpr int kDashes = 80;
  const double dash = time.span() / (2 * kDashes);
  for (std::size_t k = 0; k < paths.size(); ++k) {
    std::vector<cv::Point2d> error;
    for (std::size_t i = 0; i < paths[k].seconds.size(); ++i)
      error.emplace_back(paths[k].seconds[i], kMillimetres * paths[k].error[i]);
    chart.line(error, paths[k].breaks, paths[k].colour, 4);
    const double rmse = kMillimetres * runs[k].error.metres.rmse;
    const cv::Scalar& colour = paths.size() == 1 ? colour::kInk : paths[k].colour;
    for (int i = 0; i < kDashes; ++i)
      chart.segment({time.low + 2 * i * dash, rmse}, {time.low + (2 * i + 1) * dash, rmse}, colour,
                    3);
  }
}

std::string figures_of(const PlottedRun& run) {
  return "ATE RMSE " + fixed(1000 * run.error.metres.rmse, 1) + " mm, " +
         std::to_string(run.evaluation.pairs.size()) + " poses";
}

/// Names with their colours, in rows of three; of a single run its figures, too.
void draw_heading(cv::Mat& picture, std::span<const PlottedRun> runs,
                  const std::vector<Path>& paths) {
  constexpr int kPerRow = 3, kColumn = 860, kRow = 54, kDash = 70;
  const auto entry = [&](int place, const std::string& text, const cv::Scalar& c, int thickness) {
    const cv::Point at(kFromAbove.x + place % kPerRow * kColumn, 50 + place / kPerRow * kRow);
    cv::line(picture, at, at + cv::Point(kDash, 0), c, thickness, cv::LINE_AA);
    put_text(picture, text, at + cv::Point(kDash + 20, 0), 30, 0.0);
  };
  entry(0, "reference", colour::kReference, 9);
  const int last = std::min(static_cast<int>(runs.size()), 2 * kPerRow + 1);
  for (int k = 0; k < last; ++k)
    entry(k + 1,
          runs[static_cast<std::size_t>(k)].name + ": " +
              figures_of(runs[static_cast<std::size_t>(k)]),
          paths[static_cast<std::size_t>(k)].colour, 4);
}

}  // namespace

cv::Mat draw_plot(std::span<const PlottedRun> runs) {
  std::vector<Path> paths;
  for (const PlottedRun& run : runs)
    paths.push_back(path_of(run, kRunColours[paths.size() % std::size(kRunColours)]));
  Range time{paths[0].seconds.front(), paths[0].seconds.back()};
  for (const Path& path : paths) {
    time.include(path.seconds.front());
    time.include(path.seconds.back());
  }
  cv::Mat picture(kHeight, kWidth, CV_8UC3, cv::Scalar::all(255));
  draw_heading(picture, runs, paths);
  draw_from_above(picture, paths);
  for (int axis = 0; axis < 3; ++axis) draw_axis(picture, paths, axis, time);
  draw_error(picture, runs, paths, time);
  cv::Mat result;
  cv::resize(picture, result, {}, 1.0 / kOversampling, 1.0 / kOversampling, cv::INTER_AREA);
  return result;
}

void write_plot(std::span<const PlottedRun> runs, const std::filesystem::path& png) {
  const cv::Mat plot = draw_plot(runs);
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
