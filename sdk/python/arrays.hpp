// Between NumPy and what the engine works with. Shapes are checked; a wrong one raises ValueError.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "stillpoint/pose_math.hpp"

namespace stillpoint::python {

namespace py = pybind11;

/// A view of an H x W x 3 array of uint8, BGR. Valid while the array is.
cv::Mat color_image(const py::array& array);

/// A view of an H x W array of uint16 (as recorded) or float32 (metres). Valid while the array is.
cv::Mat depth_image(const py::array& array);

/// Whether a depth image has measurements. Throws ValueError when one of float32 is obviously in
/// millimetres.
bool is_in_metres(const cv::Mat& depth);

/// A read-only array that shares an image's pixels. An empty image is None.
py::object to_array(const cv::Mat& image);

/// 4 x 4, float64.
py::array_t<double> to_array(const Pose& pose);

/// N, and N x 4 x 4.
py::tuple to_arrays(const std::vector<StampedPose>& poses);

/// The inverse of to_arrays().
std::vector<StampedPose> stamped_poses(const py::array_t<double>& times,
                                       const py::array_t<double>& poses);

}  // namespace stillpoint::python
