#include "arrays.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "stillpoint/support/median.hpp"

namespace stillpoint::python {
namespace {

constexpr double kLargestSkew = 1e-3;      // of a rotation matrix from an orthonormal one
constexpr float kFarthestMedian = 200.0F;  // metres; a room's is above that in millimetres
constexpr int kStep = 8;                   // pixels between those looked at

std::string shape_text(const py::array& array) {
  std::string text;
  for (py::ssize_t i = 0; i < array.ndim(); ++i)
    text += (i ? " x " : "") + std::to_string(array.shape(i));
  return text + " of " + py::str(array.dtype()).cast<std::string>();
}

[[noreturn]] void refuse(const char* what, const char* wanted, const py::array& array) {
  throw py::value_error(std::string(what) + " must be " + wanted + ", but it is " +
                        shape_text(array));
}

// Rows may be apart, as in a part of a larger image; pixels may not.
cv::Mat view(const py::array& array, int type, const char* what, const char* wanted) {
  const auto pixel = static_cast<py::ssize_t>(CV_ELEM_SIZE(type));
  if (array.strides(1) != pixel || array.strides(0) < pixel * array.shape(1) ||
      (array.ndim() == 3 && array.strides(2) != 1))
    refuse(what, (std::string(wanted) + ", its pixels one after the other").c_str(), array);
  return {static_cast<int>(array.shape(0)), static_cast<int>(array.shape(1)), type,
          const_cast<void*>(array.data()), static_cast<std::size_t>(array.strides(0))};
}

Pose pose_at(const double* row_major, py::ssize_t index) {
  using Matrix = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;
  const Matrix matrix = Eigen::Map<const Matrix>(row_major + 16 * index);
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
  if (!matrix.allFinite() || matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1) ||
      (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm() > kLargestSkew)
    throw py::value_error("pose " + std::to_string(index) + " is no rigid motion");
  return Pose(Eigen::Matrix4d(matrix));
}

}  // namespace

cv::Mat color_image(const py::array& array) {
  const char* wanted = "H x W x 3 of uint8";
  if (array.ndim() != 3 || array.shape(2) != 3 || !py::isinstance<py::array_t<std::uint8_t>>(array))
    refuse("bgr", wanted, array);
  return view(array, CV_8UC3, "bgr", wanted);
}

cv::Mat depth_image(const py::array& array) {
  const char* wanted = "H x W of uint16 or float32";
  const bool raw = py::isinstance<py::array_t<std::uint16_t>>(array);
  if (array.ndim() != 2 || !(raw || py::isinstance<py::array_t<float>>(array)))
    refuse("depth", wanted, array);
  return view(array, raw ? CV_16UC1 : CV_32FC1, "depth", wanted);
}

bool is_in_metres(const cv::Mat& depth) {
  if (depth.type() != CV_32FC1) return true;
  std::vector<float> measured;
  for (int y = 0; y < depth.rows; y += kStep)
    for (int x = 0; x < depth.cols; x += kStep)
      if (const float z = depth.at<float>(y, x); z > 0) measured.push_back(z);
  const float middle = median(std::move(measured));
  if (middle >= kFarthestMedian)
    throw py::value_error("half of the first depth image lies beyond " +
                          std::to_string(std::lround(std::min(middle, 1e9F))) +
                          " m: float32 depth is in metres; give other units as uint16, whose unit "
                          "is the camera's depth_factor");
  return middle > 0;
}

py::object to_array(const cv::Mat& image) {
  if (image.empty()) return py::none();
  auto owner = std::make_unique<cv::Mat>(image);
  const py::capsule base(owner.get(), [](void* mat) { delete static_cast<cv::Mat*>(mat); });
  const cv::Mat& shared = *owner.release();
  std::vector<py::ssize_t> shape = {shared.rows, shared.cols};
  std::vector<py::ssize_t> strides = {static_cast<py::ssize_t>(shared.step[0]),
                                      static_cast<py::ssize_t>(shared.elemSize())};
  if (shared.channels() > 1) {
    shape.push_back(shared.channels());
    strides.push_back(static_cast<py::ssize_t>(shared.elemSize1()));
  }
  const py::dtype type =
      shared.depth() == CV_8U ? py::dtype::of<std::uint8_t>() : py::dtype::of<float>();
  py::array array(type, shape, strides, shared.data, base);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

py::array_t<double> to_array(const Pose& pose) {
  py::array_t<double> array({4, 4});
  Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(array.mutable_data()) = pose.matrix();
  return array;
}

py::tuple to_arrays(const std::vector<StampedPose>& poses) {
  const auto count = static_cast<py::ssize_t>(poses.size());
  py::array_t<double> times(count);
  py::array_t<double> matrices({count, py::ssize_t{4}, py::ssize_t{4}});
  for (std::size_t i = 0; i < poses.size(); ++i) {
    times.mutable_data()[i] = poses[i].time;
    Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(matrices.mutable_data() + 16 * i) =
        poses[i].world_from_camera.matrix();
  }
  return py::make_tuple(times, matrices);
}

std::vector<StampedPose> stamped_poses(const py::array_t<double>& times,
                                       const py::array_t<double>& poses) {
  if (times.ndim() != 1) refuse("times", "N numbers", times);
  if (poses.ndim() != 3 || poses.shape(0) != times.shape(0) || poses.shape(1) != 4 ||
      poses.shape(2) != 4)
    refuse("poses", "N x 4 x 4, one per time", poses);
  const auto dense = py::array_t<double, py::array::c_style | py::array::forcecast>(poses);
  std::vector<StampedPose> stamped;
  for (py::ssize_t i = 0; i < times.shape(0); ++i)
    stamped.push_back({times.at(i), pose_at(dense.data(), i)});
  return stamped;
}

}  // namespace stillpoint::python
