// Calls a stage, and remembers what it gave and how long that took.
#pragma once

#include <boost/crc.hpp>
#include <chrono>
#include <cstdint>
#include <map>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "plugin_check/finding.hpp"
#include "stillpoint/engine/stage_error.hpp"
#include "stillpoint/pose_math.hpp"

namespace stillpoint::plugin_check {

class Observer {
 public:
  /// `stage` is what messages call it: "moving_checker (my_check)".
  explicit Observer(std::string stage) : stage_(std::move(stage)) {}

  /// Calls `function`, of the stage, under the StageGuard of the process. What it throws leaves as
  /// StageError.
  template <class Function>
  auto call(const std::string& name, std::optional<std::uint32_t> frame, Function&& function)
      -> decltype(function()) {
    const auto start = Clock::now();
    const Measured measured(milliseconds_[name], start);
    return in_stage(stage_ + ": " + name, frame, function);
  }

  /// `function` throws Error(kStage) for a wrong result of a call; it leaves as StageError.
  template <class Function>
  void check(const std::string& name, std::optional<std::uint32_t> frame, Function&& function) {
    in_stage(stage_ + ": " + name, frame, function);
  }

  /// A result becomes part of the digest.
  template <class T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void saw(T value) { digest_.process_bytes(&value, sizeof(value)); }
  void saw(const Pose& pose) { digest_.process_bytes(pose.data(), sizeof(double) * 16); }
  void saw(const Eigen::Vector3d& point) { digest_.process_bytes(point.data(), sizeof(point)); }
  void saw(const std::string& text) { digest_.process_bytes(text.data(), text.size()); }
  /// Images are kept, too, to see whether the stage changes them later.
  void saw(const cv::Mat& image);

  std::uint32_t digest() const { return digest_.checksum(); }
  /// Throws Failure when an image has changed since saw().
  void require_unchanged() const;
  std::vector<CallTime> times() const;

 private:
  using Clock = std::chrono::steady_clock;

  class Measured {
   public:
    Measured(std::vector<double>& to, Clock::time_point start) : to_(to), start_(start) {}
    ~Measured() {
      to_.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start_).count());
    }
    Measured(const Measured&) = delete;
    Measured& operator=(const Measured&) = delete;

   private:
    std::vector<double>& to_;
    Clock::time_point start_;
  };
  struct Kept {
    cv::Mat image;
    std::uint32_t checksum;
  };

  std::string stage_;
  boost::crc_32_type digest_;
  std::vector<Kept> kept_;
  std::map<std::string, std::vector<double>> milliseconds_;  // by function
};

std::uint32_t checksum_of(const cv::Mat& image);

}  // namespace stillpoint::plugin_check
