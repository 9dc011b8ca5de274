#include "evaluation/evaluation.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <variant>

#include "arrays.hpp"
#include "bindings.hpp"
#include "evaluation/report.hpp"

namespace stillpoint::python {
namespace {

using Poses = std::pair<py::array_t<double>, py::array_t<double>>;
using Path = std::variant<Poses, std::filesystem::path>;

evaluation::Trajectory trajectory_of(const Path& path, const char* name) {
  if (const auto* file = std::get_if<std::filesystem::path>(&path))
    return evaluation::read_trajectory(*file);
  const auto& [times, poses] = std::get<Poses>(path);
  evaluation::Trajectory trajectory{.name = name, .poses = stamped_poses(times, poses)};
  if (trajectory.poses.empty()) throw py::value_error(std::string(name) + " has no poses");
  for (std::size_t i = 1; i < trajectory.poses.size(); ++i)
    if (!(trajectory.poses[i].time > trajectory.poses[i - 1].time))
      throw py::value_error(std::string("times of ") + name + " must rise");
  return trajectory;
}

py::object evaluate(const Path& reference, const Path& estimate, double max_difference,
                    double offset) {
  const auto result = evaluation::evaluate(trajectory_of(reference, "reference"),
                                           trajectory_of(estimate, "estimate"), {},
                                           {.max_difference = max_difference, .offset = offset});
  return py::module_::import("json").attr("loads")(evaluation::report_json(result).dump());
}

}  // namespace

void bind_evaluation(py::module_& module) {
  const evaluation::EvaluationOptions standard;
  module.def("evaluate", &evaluate,
             "The figures of 'stillpoint evaluate --json' as a dictionary: absolute trajectory\n"
             "error after the best alignment, relative pose error, coverage. Each trajectory is a\n"
             "file in the format of the TUM benchmark or (times N, poses N x 4 x 4), as\n"
             "Engine.trajectory() gives it. Poses belong together when their times differ by less\n"
             "than `max_difference` (s), with `offset` (s) added to those of the estimate.",
             py::arg("reference"), py::arg("estimate"), py::kw_only(),
             py::arg("max_difference") = standard.max_difference,
             py::arg("offset") = standard.offset);
}

}  // namespace stillpoint::python
