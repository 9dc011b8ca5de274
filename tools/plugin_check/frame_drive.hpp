// A drive that does the same for every frame of a scenario.
#pragma once

#include <filesystem>

#include "plugin_check/drive.hpp"

namespace stillpoint::plugin_check {

template <class Interface>
class FrameDrive : public Drive {
 public:
  FrameDrive(Interface& stage, const DriveSetup& setup)
      : stage_(stage),
        scenario_(setup.scenario),
        folder_(setup.folder),
        observer_(setup.observer) {}

  bool step() final {
    if (!begun_) {
      begun_ = true;
      if (begin()) return true;
    }
    if (next_ == scenario_.inputs.size()) return false;
    at(next_++);
    return true;
  }

 protected:
  /// What is asked before the first frame; false: nothing.
  virtual bool begin() { return false; }
  virtual void at(std::size_t i) = 0;

  const Input& input(std::size_t i) const { return scenario_.inputs[i]; }

  /// Calls a function of the stage with its name and frame, for times and messages.
  template <class Function>
  auto call(const char* name, std::size_t i, Function&& function) {
    return observer_.call(name, input(i).frame->index, function);
  }
  template <class Function>
  void check(const char* name, std::size_t i, Function&& function) {
    observer_.check(name, input(i).frame->index, function);
  }

  Interface& stage_;
  const Scenario& scenario_;
  const std::filesystem::path folder_;  // exists, empty
  Observer& observer_;

 private:
  bool begun_ = false;
  std::size_t next_ = 0;
};

}  // namespace stillpoint::plugin_check
