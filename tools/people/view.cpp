#include "people/view.hpp"

#include <algorithm>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace stillpoint::people {

Rays::Rays(const CameraModel& camera) : focal_(camera.fx) {
  const cv::Matx33d matrix(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
  cv::Mat pixels(camera.height, camera.width, CV_32FC2);
  for (int y = 0; y < pixels.rows; ++y)
    for (int x = 0; x < pixels.cols; ++x)
      pixels.at<cv::Vec2f>(y, x) = {static_cast<float>(x), static_cast<float>(y)};
  cv::undistortPoints(pixels.reshape(2, static_cast<int>(pixels.total())), rays_, matrix,
                      camera.distortion);
  rays_ = rays_.reshape(2, camera.height);
  if (std::ranges::all_of(camera.distortion, [](double k) { return k == 0; }) &&
      camera.crop.empty())
    return;
  const Camera ideal = camera.undistorted();
  const cv::Matx33d ideal_matrix(ideal.fx, 0, ideal.cx, 0, ideal.fy, ideal.cy, 0, 0, 1);
  cv::Mat unused;
  cv::initUndistortRectifyMap(matrix, camera.distortion, cv::noArray(), ideal_matrix,
                              {ideal.width, ideal.height}, CV_32FC2, map_, unused);
}

cv::Mat Rays::rectified(const cv::Mat& image) const {
  if (map_.empty()) return image;
  cv::Mat result;
  cv::remap(image, result, map_, cv::noArray(), cv::INTER_NEAREST, cv::BORDER_CONSTANT);
  return result;
}

Pose world_from_level(const Pose& world_from_first_camera, double floor) {
  Eigen::Vector3d ahead = world_from_first_camera.linear().col(2);
  ahead.z() = 0;
  ahead.normalize();
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  Pose pose = Pose::Identity();
  pose.linear() << ahead.cross(up), ahead, up;
  pose.translation() = world_from_first_camera.translation();
  pose.translation().z() = floor;
  return pose;
}

}  // namespace stillpoint::people
