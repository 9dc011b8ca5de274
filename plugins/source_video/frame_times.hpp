// When the images of a video were taken.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

namespace stillpoint::source_video {

class FrameTimes {
 public:
  /// From a list: the first column of each line is seconds. Throws Error(kData) when the file
  /// cannot be read, or its times do not grow.
  explicit FrameTimes(const std::filesystem::path& list);
  /// At a constant rate in Hz, from `first` on.
  FrameTimes(double first, double rate) : first_(first), rate_(rate) {}

  /// In seconds; nothing behind the end of the list.
  std::optional<double> at(std::size_t index) const;
  /// How many are known; nothing at a constant rate.
  std::optional<std::size_t> size() const;

 private:
  std::vector<double> times_;  // of the list
  double first_ = 0.0;
  double rate_ = 0.0;  // 0: there is a list
};

}  // namespace stillpoint::source_video
