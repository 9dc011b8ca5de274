// The parts of the module.
#pragma once

#include <pybind11/pybind11.h>

namespace stillpoint::python {

/// Camera, FrameReport, Engine.
void bind_engine(pybind11::module_& module);
/// evaluate().
void bind_evaluation(pybind11::module_& module);

}  // namespace stillpoint::python
