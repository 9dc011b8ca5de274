#include "stillpoint/engine/engine.hpp"
#include "stillpoint/support/option_check.hpp"
#include "stillpoint/support/rectifier.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "stillpoint/engine/map_file.hpp"

namespace stillpoint::python {
namespace {

using GilReleased = py::call_guard<py::gil_scoped_release>;

/// An engine with the camera of the images that it is given. Its threads may be many: process(),
/// finish() and trajectory() wait for each other.
class PythonEngine {
 public:
  PythonEngine(const CameraModel& camera, EngineSetup setup)
      : rectifier_(camera), engine_(std::move(setup)) {}

  FrameReportPtr process(double time, const py::array& bgr, const py::array& depth) {
    const cv::Mat color = color_image(bgr);
    const cv::Mat measured = depth_image(depth);
    if (!is_unit_known_) is_unit_known_ = is_in_metres(measured);
    const py::gil_scoped_release released;
    Frame frame = rectifier_.frame(time, color, measured);
    if (frame.bgr.data == color.data) frame.bgr = color.clone();  // the array stays its owner's
    const std::lock_guard lock(mutex_);
    return engine_.process(std::move(frame));
  }
  void finish() {
    const std::lock_guard lock(mutex_);
    engine_.finish();
  }
  std::vector<StampedPose> trajectory() {
    const std::lock_guard lock(mutex_);
    return engine_.trajectory();
  }
  Engine& engine() { return engine_; }

 private:
  Rectifier rectifier_;
  std::mutex mutex_;  // never waited for with the GIL
  Engine engine_;
  bool is_unit_known_ = false;  // of depth images: one with measurements was in metres
};

/// The end of an engine waits for its threads, without holding up those of Python.
struct DeleteWithoutGil {
  void operator()(PythonEngine* engine) const {
    const py::gil_scoped_release released;
    delete engine;
  }
};
using PythonEnginePtr = std::unique_ptr<PythonEngine, DeleteWithoutGil>;

using NamedCamera = std::variant<CameraModel, std::string>;

void warn(const std::string& text) {
  if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) != 0) throw py::error_already_set();
}

PythonEnginePtr make_engine(const std::string& pipeline, const NamedCamera& camera,
                            const std::vector<std::string>& settings,
                            const std::filesystem::path& output,
                            const std::filesystem::path& load_map, bool localise_only) {
  std::vector<std::string> warnings;
  PythonEnginePtr engine;
  {
    const py::gil_scoped_release released;
    const auto* model = std::get_if<CameraModel>(&camera);
    EngineSetup setup{.request = {.pipeline = pipeline, .assignments = settings, .pushed = true},
                      .output_directory = output,
                      .localise_only = localise_only};
    if (!load_map.empty()) setup.known_map = stillpoint::load_map(load_map);
    engine.reset(new PythonEngine(
        model ? *model : load_camera(std::get<std::string>(camera), &warnings), std::move(setup)));
  }
  for (const std::string& text : warnings) warn(text);
  return engine;
}

py::array_t<double> landmarks(PythonEngine& self) {
  const auto map = self.engine().map();
  py::array_t<double> positions({static_cast<py::ssize_t>(map->landmark_count()), py::ssize_t{3}});
  double* next = positions.mutable_data();
  for (LandmarkId id = 0; id < map->landmark_id_end(); ++id) {
    const Landmark* landmark = map->landmark(id);
    if (!landmark) continue;
    for (int axis = 0; axis < 3; ++axis) *next++ = landmark->position_in_world[axis];
  }
  return positions;
}

py::tuple keyframes(PythonEngine& self) {
  const auto map = self.engine().map();
  std::vector<StampedPose> poses;
  for (KeyFrameId id = 0; id < map->keyframe_id_end(); ++id)
    if (const KeyFrame* keyframe = map->keyframe(id))
      poses.push_back({keyframe->time, keyframe->world_from_camera});
  return to_arrays(poses);
}

py::tuple trajectory(PythonEngine& self) {
  std::vector<StampedPose> poses;
  {
    const py::gil_scoped_release released;
    poses = self.trajectory();
  }
  return to_arrays(poses);
}

py::tuple dense_map(PythonEngine& self) {
  std::vector<LabelledPoint> points;
  {
    const py::gil_scoped_release released;
    points = self.engine().dense_map();
  }
  const auto count = static_cast<py::ssize_t>(points.size());
  py::array_t<float> positions({count, py::ssize_t{3}});
  py::array_t<std::uint8_t> rgb({count, py::ssize_t{3}});
  py::array_t<std::uint8_t> labels(count);
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::copy_n(points[i].position.data(), 3, positions.mutable_data() + 3 * i);
    std::copy_n(points[i].rgb.data(), 3, rgb.mutable_data() + 3 * i);
    labels.mutable_data()[i] = points[i].label;
  }
  return py::make_tuple(positions, rgb, labels);
}

py::tuple moving_points(const FrameReport& report) {
  const auto count = static_cast<py::ssize_t>(report.moving.points.size());
  py::array_t<float> pixels({count, py::ssize_t{2}});
  py::array_t<bool> moving(count);
  for (std::size_t i = 0; i < report.moving.points.size(); ++i) {
    const PointMotion& point = report.moving.points[i];
    pixels.mutable_data()[2 * i] = point.current.x;
    pixels.mutable_data()[2 * i + 1] = point.current.y;
    moving.mutable_data()[i] = point.moving;
  }
  return py::make_tuple(pixels, moving);
}

py::object world_from_camera(const FrameReport& report) {
  if (report.result.state != TrackState::kTracking) return py::none();
  return to_array(report.result.world_from_camera);
}

void warn_of_depth_factor() {
  warn(
      "Camera: no depth_factor is given: depth images of uint16 count as 5000 for a metre, the "
      "format of TUM; millimetres need depth_factor=1000");
}

void bind_camera(py::module_& module) {
  const CameraModel standard;
  py::class_<CameraModel>(module, "Camera",
                          "A sensor as it records: pinhole, Brown-Conrady distortion, depth\n"
                          "registered to the colour image.")
      .def(py::init([](int width, int height, double fx, double fy, double cx, double cy,
                       std::optional<double> depth_factor, const std::vector<double>& distortion,
                       double min_depth, double max_depth, double depth_noise, double surface_noise,
                       const std::vector<double>& crop) {
             if (!depth_factor) warn_of_depth_factor();
             CameraModel model{.name = "camera",
                               .width = width,
                               .height = height,
                               .fx = fx,
                               .fy = fy,
                               .cx = cx,
                               .cy = cy,
                               .distortion = distortion,
                               .depth_factor = depth_factor.value_or(CameraModel().depth_factor),
                               .min_depth = min_depth,
                               .max_depth = max_depth,
                               .depth_noise = depth_noise,
                               .surface_noise = surface_noise,
                               .crop = crop};
             check_options(model, "Camera");
             return model;
           }),
           "Pixel (0, 0) is the centre of the top left pixel. `distortion`: k1, k2, p1, p2[, k3].\n"
           "`depth_factor`: value of one metre in a depth image of uint16, 1000 for millimetres;\n"
           "without it 5000, as in the format of TUM, with a warning. Depth images of float32 are\n"
           "in metres, whatever it is. Depth outside of\n"
           "`min_depth` to `max_depth` (m) is not used. `depth_noise`, `surface_noise`: standard\n"
           "deviations at 1 m (m), of a point feature and of the sensor itself. `crop`: x, y, "
           "width, height (px) of the\n"
           "part of the undistorted image to use.",
           py::kw_only(), py::arg("width"), py::arg("height"), py::arg("fx"), py::arg("fy"),
           py::arg("cx"), py::arg("cy"), py::arg("depth_factor") = py::none(),
           py::arg("distortion") = standard.distortion, py::arg("min_depth") = standard.min_depth,
           py::arg("max_depth") = standard.max_depth, py::arg("depth_noise") = standard.depth_noise,
           py::arg("surface_noise") = standard.surface_noise, py::arg("crop") = standard.crop);
}

void bind_report(py::module_& module) {
  py::class_<FrameReport, std::shared_ptr<FrameReport>>(
      module, "FrameReport",
      "What is known of one frame. Images are of the undistorted frame and read-only; they share\n"
      "their pixels with the engine.")
      .def_property_readonly(
          "index", [](const FrameReport& r) { return r.frame->index; },
          "0, 1, 2, ... in the order of process().")
      .def_property_readonly(
          "time", [](const FrameReport& r) { return r.frame->time; }, "Seconds.")
      .def_property_readonly(
          "tracked", [](const FrameReport& r) { return r.result.state == TrackState::kTracking; },
          "Whether there is a pose.")
      .def_property_readonly(
          "lost", [](const FrameReport& r) { return r.result.state == TrackState::kLost; },
          "Whether there was a map and the camera was not found in it.")
      .def_property_readonly("world_from_camera", world_from_camera,
                             "4 x 4, by the map of that moment; None when not tracked.")
      .def_property_readonly(
          "is_keyframe", [](const FrameReport& r) { return r.result.keyframe.has_value(); },
          "Whether the frame is kept in the map.")
      .def_property_readonly(
          "begins_anew", [](const FrameReport& r) { return r.result.begins_anew; },
          "Whether the map so far was given up: this frame is the origin of a new one, and frames\n"
          "before have no pose in it.")
      .def_property_readonly(
          "inliers", [](const FrameReport& r) { return r.result.inliers; },
          "Features that fit the pose.")
      .def_property_readonly(
          "bgr", [](const FrameReport& r) { return to_array(r.frame->bgr); }, "H x W x 3, uint8.")
      .def_property_readonly(
          "depth", [](const FrameReport& r) { return to_array(r.frame->depth); },
          "H x W, float32, metres; 0: no measurement.")
      .def_property_readonly(
          "labels", [](const FrameReport& r) { return to_array(r.segmentation->labels); },
          "H x W, uint8: index into Engine.classes; None: nothing is known.")
      .def_property_readonly(
          "track_weights", [](const FrameReport& r) { return to_array(r.weights->track); },
          "H x W, uint8: 255 static ... 0 not tracked by; None: 255 everywhere.")
      .def_property_readonly(
          "map_weights", [](const FrameReport& r) { return to_array(r.weights->map); },
          "H x W, uint8: 255 static ... 0 not mapped; None: 255 everywhere.")
      .def_property_readonly("moving_points", moving_points,
                             "(pixels N x 2, moving N): points followed from the frame before.");
}

void bind_engine_class(py::module_& module) {
  py::class_<PythonEngine, PythonEnginePtr>(
      module, "Engine",
      "One run of a pipeline over images that are handed to process(), one after the other.")
      .def(
          py::init(&make_engine),
          "`pipeline`: a file, or a name from configs/pipelines. `camera`: a Camera, or a file or\n"
          "name from configs/cameras. `settings`: as after --set, 'tracker.features=2000'.\n"
          "`output`: folder for what the pipeline's outputs write and for the dense map; '':\n"
          "nothing is written. `load_map`: file of an earlier save_map() to begin with;\n"
          "`localise_only`: it stays as it is. Raises Error with every fault that it finds.",
          py::arg("pipeline"), py::arg("camera"), py::kw_only(),
          py::arg("settings") = std::vector<std::string>(), py::arg("output") = "",
          py::arg("load_map") = "", py::arg("localise_only") = false)
      .def(
          "process", &PythonEngine::process, py::arg("time"), py::arg("bgr"), py::arg("depth"),
          "Estimates the pose of the next frame and returns its FrameReport. `time`: seconds, not\n"
          "before that of the last frame. `bgr`: H x W x 3, uint8. `depth`: H x W, registered to\n"
          "bgr; uint16 as recorded, or float32 in metres. Raises Error for a frame that cannot be\n"
          "used, which then counts for nothing, and when a stage has failed.")
      .def("finish", &PythonEngine::finish, GilReleased(),
           "Completes the maps and writes the outputs. Once; no frame may follow.")
      .def("trajectory", &trajectory,
           "(times N, poses N x 4 x 4) of the frames that were tracked, by what the map says now.")
      .def("keyframes", &keyframes, "(times N, poses N x 4 x 4) of the key frames.")
      .def("landmarks", &landmarks, "N x 3: points of the sparse map, metres in the world.")
      .def("dense_map", &dense_map,
           "(positions N x 3 float32, rgb N x 3 uint8, labels N uint8): what is occupied, metres "
           "in\n"
           "the world, with colour and index into classes.")
      .def_property_readonly(
          "classes", [](PythonEngine& self) { return self.engine().classes(); },
          "Names of the labels.")
      .def(
          "save_map",
          [](PythonEngine& self, const std::filesystem::path& file) {
            save_map(*self.engine().map(), file);
          },
          py::arg("file"), GilReleased(), "Keeps the sparse map in a file.");
}

}  // namespace

void bind_engine(py::module_& module) {
  bind_camera(module);
  bind_report(module);
  bind_engine_class(module);
}

}  // namespace stillpoint::python
