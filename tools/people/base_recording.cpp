#include "people/base_recording.hpp"

#include <array>
#include <cstdio>
#include <fstream>

#include "simulation/mesh.hpp"
#include "stillpoint/error.hpp"
#include "stillpoint/support/image_codec.hpp"
#include "stillpoint/support/image_file.hpp"

namespace stillpoint::people {
namespace {

namespace fs = std::filesystem;

std::vector<BasePair> read_pairs(const fs::path& folder) {
  std::ifstream list(folder / "associations.txt");
  std::vector<BasePair> pairs;
  std::string color, depth;
  for (BasePair pair; list >> pair.time >> color >> pair.depth_time >> depth;) {
    pair.color = folder / color;
    pair.depth = folder / depth;
    pairs.push_back(pair);
  }
  if (pairs.empty())
    throw Error(Fault::kData, "there are no pairs of images",
                (folder / "associations.txt").string(),
                "expected lines 'time rgb/FILE time depth/FILE'");
  return pairs;
}

cv::Mat read_image(const fs::path& file, int flags) {
  cv::Mat image = decode_image(read_image_file(file), flags);
  if (image.empty()) throw Error(Fault::kData, "the image cannot be read", file.string());
  return image;
}

}  // namespace

BaseRecording::BaseRecording(const BasePlan& plan, const CameraModel& camera)
    : plan_(plan),
      camera_(camera),
      rays_(camera),
      pairs_(read_pairs(plan.folder)),
      truth_(evaluation::read_trajectory(ground_truth())) {}

fs::path BaseRecording::ground_truth() const { return fs::path(plan_.folder) / "groundtruth.txt"; }

Pose BaseRecording::world_from_camera(double time) const {
  return evaluation::pose_at(truth_, time);
}

cv::Mat BaseRecording::color(const BasePair& pair) const {
  return read_image(pair.color, cv::IMREAD_COLOR);
}

cv::Mat BaseRecording::depth(const BasePair& pair) const {
  cv::Mat metres;
  read_image(pair.depth, cv::IMREAD_UNCHANGED).convertTo(metres, CV_32F, 1 / camera_.depth_factor);
  return metres;
}

/// What the depth image shows between the two heights of the plan.
cv::Mat BaseRecording::desk_of(const BasePair& pair) const {
  const cv::Mat z = depth(pair);
  cv::Mat desk = cv::Mat::zeros(z.size(), CV_8U);
  const Pose pose = world_from_camera(pair.depth_time);
  for (int y = 0; y < z.rows; ++y) {
    for (int x = 0; x < z.cols; ++x) {
      const cv::Vec2f& ray = rays_.at(y, x);
      const double height = (pose * (z.at<float>(y, x) * Eigen::Vector3d(ray[0], ray[1], 1))).z();
      const bool on_desk =
          z.at<float>(y, x) > 0 && height >= plan_.desk[0] && height <= plan_.desk[1];
      if (on_desk) desk.at<std::uint8_t>(y, x) = simulation::kDiningTable;
    }
  }
  return desk;
}

cv::Mat BaseRecording::labels(const BasePair& pair) const {
  const fs::path file = fs::path(plan_.folder) / "labels" / pair.color.filename();
  if (fs::exists(file)) return read_image(file, cv::IMREAD_GRAYSCALE);
  if (!plan_.desk.empty()) return rays_.rectified(desk_of(pair)).clone();
  const Camera ideal = camera_.undistorted();
  return cv::Mat::zeros(ideal.height, ideal.width, CV_8U);
}

}  // namespace stillpoint::people
