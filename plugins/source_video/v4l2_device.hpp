// One stream of images of a device of V4L2.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "source_video/v4l2_calls.hpp"

namespace stillpoint::source_video {

/// What a device is to send.
struct V4l2Format {
  std::uint32_t pixels = 0;  ///< V4L2_PIX_FMT_…
  int width = 0, height = 0;
  int rate = 0;  ///< Hz
};

/// An image in a buffer of the device.
struct V4l2Image {
  std::span<const std::uint8_t> bytes;
  std::size_t stride = 0;          ///< bytes from row to row
  std::uint64_t microseconds = 0;  ///< of the device's driver, on the computer's steady clock
};

class V4l2Device {
 public:
  /// Opens it and chooses the format. Throws Error(kData) when there is no such device or another
  /// program has it, Error(kUsage) when it does not have this format. `calls` outlives it.
  V4l2Device(std::string name, const V4l2Format& format, V4l2Calls& calls);
  ~V4l2Device();
  V4l2Device(const V4l2Device&) = delete;
  V4l2Device& operator=(const V4l2Device&) = delete;

  const std::string& name() const { return name_; }
  /// For V4l2Calls::wait().
  int descriptor() const { return descriptor_; }

  /// It sends images from then on.
  void start();
  /// Calls `use` with each image that has come, and gives its buffer back. Those that the device
  /// says are damaged are left out: their number is given. Throws Error(kData) when the device is
  /// gone.
  std::size_t take(const std::function<void(const V4l2Image&)>& use);

 private:
  struct Buffer {
    void* memory;
    std::size_t size;
  };

  void control(unsigned long request, void* argument, const char* what);
  void choose(const V4l2Format& format);
  void share_buffers();
  void give_back(std::uint32_t index);

  std::string name_;
  V4l2Calls& calls_;
  int descriptor_;
  std::size_t stride_ = 0;
  std::vector<Buffer> buffers_;
};

}  // namespace stillpoint::source_video
