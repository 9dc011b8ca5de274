// Real people in a real recording, with a known truth: two who were photographed at a desk are cut
// out and wander through a recording without anybody, before and behind what is there.
#pragma once

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "stillpoint/contracts/camera.hpp"
#include "support/recording_writer.hpp"
#include "evaluation/trajectory.hpp"

namespace stillpoint::testing {

/// From the waist up, as flat as a stage set but for some relief.
struct CutOut {
  cv::Mat bgr;     ///< CV_32FC3
  cv::Mat alpha;   ///< CV_32FC1, 0 outside … 1
  cv::Mat relief;  ///< CV_32FC1, metres towards the camera
  double height;   ///< metres
};

/// The person in a part of a photograph `name`.png, whose mask is in `name`_gt.png.
inline CutOut cut_out(const std::filesystem::path& photos, const std::string& name, cv::Rect part,
                      double height) {
  const cv::Mat photo = cv::imread(photos / (name + ".png"));
  const cv::Mat drawn = cv::imread(photos / (name + "_gt.png"), cv::IMREAD_GRAYSCALE);
  if (photo.empty() || drawn.empty())
    throw std::runtime_error("no " + name + " in " + photos.string());
  const cv::Mat mask = drawn(part) == 255;
  CutOut person{.height = height};
  photo(part).convertTo(person.bgr, CV_32F);
  cv::Mat inner;
  cv::erode(mask, inner, cv::Mat::ones(3, 3, CV_8U));
  inner.convertTo(person.alpha, CV_32F, 1.0 / 255);
  cv::GaussianBlur(person.alpha, person.alpha, {5, 5}, 0);
  cv::distanceTransform(mask, person.relief, cv::DIST_L2, 5);
  cv::sqrt(cv::min(person.relief / 60, 1.0), person.relief);
  person.relief *= 0.1;
  return person;
}

/// How somebody wanders from side to side: lengths in metres, times in seconds.
struct Stroll {
  double period;
  double start;  ///< rad
  double reach;
  double depth;  ///< mean distance of the first camera
};

class PastedPeople {
 public:
  /// `first_camera`: world_from_camera of the first frame; people stroll in its view. Other seeds:
  /// other strolls, other noise.
  PastedPeople(const std::filesystem::path& photos, const Camera& camera, const Pose& first_camera,
               int seed)
      : camera_(camera), world_from_first_(first_camera), random_(static_cast<unsigned>(seed)) {
    const std::string photo = "tum_1341846434.710184";
    people_ = {cut_out(photos, photo, {40, 200, 210, 276}, 0.5),
               cut_out(photos, photo, {345, 255, 260, 221}, 0.45)};
    for (const double depth : {0.78, 0.64})  // the farther one first
      strolls_.push_back({.period = random_.uniform(4.0, 9.0),
                          .start = random_.uniform(0.0, 2 * std::numbers::pi),
                          .reach = random_.uniform(0.45, 0.7),
                          .depth = depth});
  }

  /// `bgr`: CV_8UC3; `depth`: CV_32FC1, metres, 0 = no measurement; `time`: seconds from the first.
  void paste(const Pose& world_from_camera, double time, cv::Mat& bgr, cv::Mat& depth) {
    const Pose camera_from_first = world_from_camera.inverse() * world_from_first_;
    for (std::size_t i = 0; i < people_.size(); ++i)
      paste(people_[i], strolls_[i], camera_from_first, time, bgr, depth);
  }

 private:
  static constexpr double kWaist = 0.4;    // metres below the first camera
  static constexpr double kNearest = 0.3;  // metres: who comes nearer is left out

  static double wave(double time, double period, double start = 0) {
    return std::sin(2 * std::numbers::pi * time / period + start);
  }

  void paste(const CutOut& person, const Stroll& stroll, const Pose& camera_from_first, double time,
             cv::Mat& bgr, cv::Mat& depth) {
    const auto corners = corners_in_camera(person, stroll, camera_from_first, time);
    std::array<cv::Point2f, 4> pixels;
    double z = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      if (corners[i].z() < kNearest) return;
      const Eigen::Vector2d pixel = camera_.project(corners[i]);
      pixels[i] = {static_cast<float>(pixel.x()), static_cast<float>(pixel.y())};
      z += corners[i].z() / 4;
    }
    const auto w = static_cast<float>(person.bgr.cols), h = static_cast<float>(person.bgr.rows);
    const std::array<cv::Point2f, 4> cut = {{{0, 0}, {w, 0}, {w, h}, {0, h}}};
    const cv::Mat homography = cv::getPerspectiveTransform(cut.data(), pixels.data());
    const auto warped = [&](const cv::Mat& image) {
      cv::Mat rippled, result;
      cv::remap(image, rippled, ripple(image.size(), time), {}, cv::INTER_LINEAR);
      cv::warpPerspective(rippled, result, homography, bgr.size());
      return result;
    };
    blend(warped(person.bgr), warped(person.alpha), z - warped(person.relief), bgr, depth);
  }

  /// Of the cut-out, clockwise from its top left: it sways about its waist and looks ahead.
  static std::array<Eigen::Vector3d, 4> corners_in_camera(const CutOut& person,
                                                          const Stroll& stroll,
                                                          const Pose& camera_from_first,
                                                          double time) {
    const double width = person.height * person.bgr.cols / person.bgr.rows;
    const bool ahead = wave(time, stroll.period, stroll.start + std::numbers::pi / 2) < 0;
    const double left = (ahead ? -0.5 : 0.5) * width;
    const Eigen::AngleAxisd sway(0.07 * wave(time, 1.3), Eigen::Vector3d::UnitZ());
    const Eigen::Vector3d waist(stroll.reach * wave(time, stroll.period, stroll.start), kWaist,
                                stroll.depth + 0.07 * wave(time, 11));
    std::array<Eigen::Vector3d, 4> corners = {
        {{left, -person.height, 0}, {-left, -person.height, 0}, {-left, 0, 0}, {left, 0, 0}}};
    for (Eigen::Vector3d& corner : corners) corner = camera_from_first * (waist + sway * corner);
    return corners;
  }

  /// Nobody is rigid: every row swings to and fro.
  static cv::Mat ripple(cv::Size size, double time) {
    cv::Mat map(size, CV_32FC2);
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x)
        map.at<cv::Vec2f>(y, x) = {static_cast<float>(x + 5 * std::sin(y / 45.0 + 4 * time)),
                                   static_cast<float>(y)};
    return map;
  }

  void blend(const cv::Mat& person, const cv::Mat& alpha, const cv::Mat& z, cv::Mat& bgr,
             cv::Mat& depth) {
    cv::Mat noise(z.size(), CV_32F), visible = alpha.clone();
    random_.fill(noise, cv::RNG::NORMAL, 0, 0.0015);
    visible.setTo(0, (depth > 0) & (depth <= z));
    const cv::Mat there = visible > 0.5;
    cv::Mat weights, mixed;
    cv::merge(std::vector<cv::Mat>(3, visible), weights);
    bgr.convertTo(mixed, CV_32F);
    mixed += weights.mul(person - mixed);
    mixed.convertTo(bgr, CV_8U);
    // The sensor's projector is to the right of its camera: to the left of near things is a shadow.
    cv::Mat shadow;
    cv::warpAffine(there, shadow, cv::Matx23d(1, 0, -7, 0, 1, 0), there.size(), cv::INTER_NEAREST);
    depth.setTo(0, shadow);
    cv::Mat measured = z + noise.mul(z.mul(z));
    measured.setTo(0, visible < 0.95);
    measured.copyTo(depth, there);
  }

  Camera camera_;
  Pose world_from_first_;
  cv::RNG random_;
  std::vector<CutOut> people_;
  std::vector<Stroll> strolls_;
};

/// Writes pairs `first` … `first + count` of the recording, which has an associations.txt and was
/// taken with TUM's freiburg1 camera, to `out`.
inline void paste_people(const std::filesystem::path& recording,
                         const std::filesystem::path& photos, int seed, std::size_t first,
                         std::size_t count, const std::filesystem::path& out) {
  constexpr double kDepthFactor = 5000;
  const Camera camera{
      .fx = 517.3, .fy = 516.5, .cx = 318.6, .cy = 255.3};  // distortion is left out
  const evaluation::Trajectory truth = evaluation::read_trajectory(recording / "groundtruth.txt");
  std::ifstream pairs(recording / "associations.txt");
  std::optional<PastedPeople> people;
  RecordingWriter writer(out);
  double time, depth_time, start = 0;
  std::string color_file, depth_file;
  for (std::size_t i = 0;
       pairs >> time >> color_file >> depth_time >> depth_file && i < first + count; ++i) {
    if (i < first) continue;
    const Pose world_from_camera = pose_at(truth, time);
    if (!people) {
      people.emplace(photos, camera, world_from_camera, seed);
      start = time;
    }
    cv::Mat bgr = cv::imread(recording / color_file);
    cv::Mat depth = cv::imread(recording / depth_file, cv::IMREAD_UNCHANGED);
    if (bgr.empty() || depth.empty())
      throw std::runtime_error("cannot read " + color_file + " or " + depth_file);
    depth.convertTo(depth, CV_32F, 1 / kDepthFactor);
    people->paste(world_from_camera, time - start, bgr, depth);
    depth.convertTo(depth, CV_16U, kDepthFactor);
    writer.color(time, bgr);
    writer.depth(depth_time, depth);
  }
  if (!people) throw std::runtime_error("no pairs in " + (recording / "associations.txt").string());
  std::filesystem::copy_file(recording / "groundtruth.txt", out / "groundtruth.txt",
                             std::filesystem::copy_options::overwrite_existing);
}

}  // namespace stillpoint::testing
