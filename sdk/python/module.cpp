// The Python module `stillpoint`.
#include <exception>
#include <utility>

#include "bindings.hpp"
#include "stillpoint/error.hpp"

namespace py = pybind11;

PYBIND11_MODULE(stillpoint, module) {
  module.doc() =
      "RGB-D SLAM for scenes in which people and things move.\n\n"
      "Images go in as NumPy arrays; poses, labels, weights and maps come out as such. Poses are\n"
      "4 x 4 matrices world_from_camera in metres: x right, y down, z forward; the world is the\n"
      "first camera. Times are in seconds.";
  module.attr("__version__") = STILLPOINT_VERSION;
  static const py::exception<stillpoint::Error> error(module, "Error", PyExc_RuntimeError);
  error.doc() = "What went wrong, where, and what to do about it.";
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(std::move(thrown));
    } catch (const stillpoint::Error& fault) {
      PyErr_SetString(error.ptr(), fault.what());
    }
  });
  stillpoint::python::bind_engine(module);
  stillpoint::python::bind_evaluation(module);
}
