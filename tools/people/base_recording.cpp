#include "people/base_recording.hpp"

#include <array>
#include <cstdio>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "stillpoint/error.hpp"

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
    throw Error(Fault::kData, "there are no pairs of images", (folder / "associations.txt").string(),
                "expected lines 'time rgb/FILE time depth/FILE'");
  return pairs;
}

cv::Mat read_image(const fs::path& file, int flags) {
  cv::Mat image = cv::imread(file, flags);
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

cv::Mat BaseRecording::labels(const BasePair& pair) const {
  const fs::path file = fs::path(plan_.folder) / "labels" / pair.color.filename();
  if (fs::exists(file)) return read_image(file, cv::IMREAD_GRAYSCALE);
  const Camera ideal = camera_.undistorted();
  return cv::Mat::zeros(ideal.height, ideal.width, CV_8U);
}

}  // namespace stillpoint::people
