// A recording of a bare wall, and a person cut out of a photograph that was painted.
#pragma once

#include <filesystem>
#include <fstream>
#include <opencv2/imgproc.hpp>
#include <string>

#include "people/maker.hpp"
#include "support/image_io.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint::people {

/// 1.4 m above the floor, level.
inline CameraModel small_camera() {
  return {.name = "small", .width = 160, .height = 120, .fx = 134, .fy = 134, .cx = 80, .cy = 60};
}

inline constexpr double kEyes = 1.4;  ///< m above the floor

/// World from a camera at the origin that looks along +y.
inline Pose level_camera() {
  Pose pose = Pose::Identity();
  pose.linear() << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  pose.translation() = Eigen::Vector3d(0, 0, kEyes);
  return pose;
}

/// A gray wall at `wall` metres, seen `frames` times at 10 Hz by a camera that stands still.
inline BasePlan write_base(const std::filesystem::path& folder, int frames, double wall) {
  testing::RecordingWriter writer(folder);
  std::ofstream pairs(folder / "associations.txt"), truth(folder / "groundtruth.txt");
  const Eigen::Quaterniond q(level_camera().linear());
  for (int i = 0; i < frames; ++i) {
    const double time = 1 + 0.1 * i;
    writer.pair(time, cv::Mat(120, 160, CV_8UC3, cv::Scalar::all(90)),
                cv::Mat(120, 160, CV_16U, cv::Scalar(5000 * wall)));
    const std::string stamp = testing::stamp_text(time), name = "/" + stamp + ".png";
    pairs << stamp << " rgb" << name << " " << stamp << " depth" << name << "\n";
    truth << stamp << " 0 0 " << kEyes << " " << q.x() << " " << q.y() << " " << q.z() << " "
          << q.w() << "\n";
  }
  return {.folder = folder, .blur = 0};
}

/// A red figure, 300 px high and 120 px wide.
inline PersonPhoto write_person(const testing::TemporaryFolder& folder,
                                const std::string& name = "person") {
  cv::Mat photo(360, 240, CV_8UC3, cv::Scalar::all(90)), mask(360, 240, CV_8U, cv::Scalar(0));
  const cv::Rect box(60, 30, 120, 300);
  cv::ellipse(mask, {{120, 180}, cv::Size2f(box.size()), 0}, 255, cv::FILLED);
  photo.setTo(cv::Scalar(20, 20, 200), mask);
  const PersonPhoto result{.image = folder.path() / (name + ".webp"),
                           .mask = folder.path() / (name + ".png")};
  testing::write_image(result.image, photo);
  testing::write_image(result.mask, mask);
  return result;
}

}  // namespace stillpoint::people
