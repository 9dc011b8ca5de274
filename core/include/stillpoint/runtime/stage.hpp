// How the runtime calls a stage.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "stillpoint/engine/stage_error.hpp"
#include "stillpoint/engine/stages.hpp"
#include "stillpoint/runtime/null_stages.hpp"
#include "stillpoint/runtime/time_log.hpp"

namespace stillpoint {

/// Calls a stage: names it when it fails and measures it. Null stages are not measured.
template <class Interface>
class StageCaller {
 public:
  /// `role` is what messages call the stage: "local mapping".
  StageCaller(Stage<Interface> stage, const std::string& role, TimeLog& times)
      : present_(stage.object != nullptr),
        object_(present_ ? std::move(stage.object) : make_null_stage<Interface>()),
        name_(stage.type.empty() ? role : role + " (" + stage.type + ")"),
        times_(times) {}

  /// Calls a member function; `label` names its time.
  template <class Function, class... Arguments>
  auto call(const char* label, std::uint32_t frame, Function function, Arguments&&... arguments) {
    std::optional<ScopedTime> time;
    if (present_) time.emplace(times_, label, frame);
    return call_unmeasured(frame, function, std::forward<Arguments>(arguments)...);
  }

  template <class Function, class... Arguments>
  auto call_unmeasured(std::optional<std::uint32_t> frame, Function function,
                       Arguments&&... arguments) {
    return in_stage(
        name_, frame,
        [&] { return std::invoke(function, *object_, std::forward<Arguments>(arguments)...); },
        &usable_);
  }

  bool present() const { return present_; }
  /// False once a guard had to end a call: another one could hang on locks that are still held.
  bool usable() const { return usable_; }
  Interface& object() const { return *object_; }

 private:
  bool present_;
  std::atomic<bool> usable_{true};  // calls may come from several threads
  std::shared_ptr<Interface> object_;
  std::string name_;
  TimeLog& times_;
};

}  // namespace stillpoint
