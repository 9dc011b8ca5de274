// Libraries of drivers, loaded when a camera is used: every command loads every plugin, and few
// need a camera.
#pragma once

#include <string>

#include "stillpoint/error.hpp"

namespace stillpoint::live_camera {

/// A shared library with C functions, loaded by the constructor. It stays loaded until the process
/// ends: its threads may outlive the source. Thread-safe.
class DriverLibrary {
 public:
  /// `file` as the dynamic loader knows it ("libfreenect.so.0.5"). Throws Error(kUsage) when it
  /// cannot be loaded, naming the Debian package that has it.
  DriverLibrary(std::string file, const std::string& package);

  /// The function of this name, as a linked program would get it: that of a preloaded library comes
  /// first. Throws Error(kUsage) when there is none.
  template <class Function>
  Function* function(const char* name) const {
    return reinterpret_cast<Function*>(symbol(name));
  }

 private:
  void* symbol(const char* name) const;

  std::string file_;
  void* handle_;
};

/// Calls functions of a driver from a destructor. One that is missing has nothing to undo.
template <class Function>
void undo_in_driver(Function&& functions) noexcept {
  try {
    functions();
  } catch (const Error&) {
  }
}

/// Defines a C function that a driver's header declares: its first call loads `library()`, a
/// function that gives a DriverLibrary. Source and inline code of the header then need not know
/// that the library is loaded late.
#define STILLPOINT_FORWARD_TO_DRIVER(library, name, parameters, arguments)   \
  extern "C" auto name parameters->decltype(name arguments) {                \
    static auto* const function = library().function<decltype(name)>(#name); \
    return function arguments;                                               \
  }

}  // namespace stillpoint::live_camera
