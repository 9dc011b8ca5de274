// Devices of V4L2 that do what a test has written down.
#pragma once

#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "source_video/v4l2_calls.hpp"

namespace stillpoint::source_video {

struct FakeImage {
  std::vector<std::uint8_t> bytes;
  std::uint64_t microseconds = 0;
  bool damaged = false;
};

/// From opening a device to closing it.
struct FakeSession {
  std::deque<FakeImage> images;
  bool ends_unplugged = false;  ///< after them; otherwise no more come
};

struct FakeDevice {
  std::string name;
  std::uint32_t pixels = 0;
  std::uint32_t width = 0, height = 0, stride = 0;
  /// One for each attempt to open it; nothing: it is not there.
  std::deque<std::optional<FakeSession>> sessions;
  std::uint32_t can = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;

  std::vector<std::vector<std::uint8_t>> buffers = {};
  std::deque<std::uint32_t> free_buffers = {};
  FakeSession now = {};
};

/// One thread at a time. The descriptor of a device is its place in the list.
class FakeV4l2 final : public V4l2Calls {
 public:
  explicit FakeV4l2(std::vector<FakeDevice> devices) : devices_(std::move(devices)) {}

  int open(const char* name) override {
    const auto device = std::ranges::find(devices_, std::string(name), &FakeDevice::name);
    if (device == devices_.end() || device->sessions.empty()) return failed(ENOENT);
    const auto session = std::move(device->sessions.front());
    device->sessions.pop_front();
    if (!session) return failed(ENOENT);
    device->now = *session;
    device->free_buffers.clear();
    return static_cast<int>(device - devices_.begin());
  }
  void close(int) override {}

  int control(int descriptor, unsigned long request, void* argument) override {
    FakeDevice& device = devices_.at(static_cast<std::size_t>(descriptor));
    switch (request) {
      case VIDIOC_QUERYCAP:
        static_cast<v4l2_capability*>(argument)->capabilities = device.can;
        return 0;
      case VIDIOC_S_FMT:
        set_format(device, static_cast<v4l2_format*>(argument)->fmt.pix);
        return 0;
      case VIDIOC_REQBUFS:
        device.buffers.assign(static_cast<v4l2_requestbuffers*>(argument)->count,
                              std::vector<std::uint8_t>(kBufferSize));
        return 0;
      case VIDIOC_QUERYBUF:
        static_cast<v4l2_buffer*>(argument)->length = kBufferSize;
        static_cast<v4l2_buffer*>(argument)->m.offset = static_cast<v4l2_buffer*>(argument)->index;
        return 0;
      case VIDIOC_QBUF:
        device.free_buffers.push_back(static_cast<v4l2_buffer*>(argument)->index);
        return 0;
      case VIDIOC_DQBUF:
        return give(device, *static_cast<v4l2_buffer*>(argument));
      default:
        return 0;
    }
  }
  void* map(int descriptor, std::size_t, off_t offset) override {
    return devices_.at(static_cast<std::size_t>(descriptor))
        .buffers.at(static_cast<std::size_t>(offset))
        .data();
  }
  void unmap(void*, std::size_t) override {}
  void wait(std::span<pollfd> descriptors, std::chrono::milliseconds) override {
    for (const pollfd& each : descriptors) {
      const FakeSession& now = devices_.at(static_cast<std::size_t>(each.fd)).now;
      if (!now.images.empty() || now.ends_unplugged) return;
    }
    ::poll(nullptr, 0, 1);
  }

 private:
  static constexpr std::uint32_t kBufferSize = 4096;

  static int failed(int reason) {
    errno = reason;
    return -1;
  }
  static void set_format(const FakeDevice& device, v4l2_pix_format& format) {
    format.width = device.width;
    format.height = device.height;
    format.pixelformat = device.pixels;
    format.bytesperline = device.stride;
  }
  static int give(FakeDevice& device, v4l2_buffer& buffer) {
    if (device.now.images.empty()) return failed(device.now.ends_unplugged ? ENODEV : EAGAIN);
    if (device.free_buffers.empty()) return failed(EAGAIN);
    const FakeImage image = device.now.images.front();
    device.now.images.pop_front();
    buffer.index = device.free_buffers.front();
    device.free_buffers.pop_front();
    std::ranges::copy(image.bytes, device.buffers.at(buffer.index).begin());
    buffer.bytesused = static_cast<std::uint32_t>(image.bytes.size());
    buffer.flags = image.damaged ? V4L2_BUF_FLAG_ERROR : 0;
    buffer.timestamp.tv_sec = static_cast<long>(image.microseconds / 1'000'000);
    buffer.timestamp.tv_usec = static_cast<long>(image.microseconds % 1'000'000);
    return 0;
  }

  std::vector<FakeDevice> devices_;
};

}  // namespace stillpoint::source_video
