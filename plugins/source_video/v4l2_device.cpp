#include "source_video/v4l2_device.hpp"

#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "stillpoint/error.hpp"
#include "stillpoint/support/size_text.hpp"

namespace stillpoint::source_video {
namespace {

constexpr std::uint32_t kBuffers = 4;  // images that may wait for this computer

/// "MJPG".
std::string fourcc_text(std::uint32_t code) {
  std::string text;
  for (int i = 0; i < 4; ++i) text += static_cast<char>((code >> (8 * i)) & 0x7f);
  return text;
}

std::string format_text(std::uint32_t pixels, int width, int height) {
  return size_text({width, height}) + " pixels of " + fourcc_text(pixels);
}

v4l2_buffer capture_buffer(std::uint32_t index = 0) {
  v4l2_buffer buffer{};
  buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  buffer.memory = V4L2_MEMORY_MMAP;
  buffer.index = index;
  return buffer;
}

}  // namespace

V4l2Device::V4l2Device(std::string name, const V4l2Format& format, V4l2Calls& calls)
    : name_(std::move(name)), calls_(calls), descriptor_(calls.open(name_.c_str())) {
  if (descriptor_ < 0)
    throw Error(Fault::kData, std::string("cannot be opened: ") + std::strerror(errno), name_,
                "'v4l2-ctl --list-devices' lists what is connected");
  try {
    choose(format);
  } catch (const Error&) {
    calls_.close(descriptor_);
    throw;
  }
}

V4l2Device::~V4l2Device() {
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  calls_.control(descriptor_, VIDIOC_STREAMOFF, &type);
  for (const Buffer& buffer : buffers_) calls_.unmap(buffer.memory, buffer.size);
  calls_.close(descriptor_);
}

void V4l2Device::control(unsigned long request, void* argument, const char* what) {
  if (calls_.control(descriptor_, request, argument) >= 0) return;
  throw Error(Fault::kData, std::string(what) + ": " + std::strerror(errno), name_,
              "check that it is plugged in and used by no other program");
}

void V4l2Device::choose(const V4l2Format& format) {
  v4l2_capability can{};
  control(VIDIOC_QUERYCAP, &can, "it is no device of V4L2");
  const std::uint32_t does =
      can.capabilities & V4L2_CAP_DEVICE_CAPS ? can.device_caps : can.capabilities;
  if (!(does & V4L2_CAP_VIDEO_CAPTURE) || !(does & V4L2_CAP_STREAMING))
    throw Error(Fault::kUsage, "this device sends no images", name_,
                "a camera has several devices; 'v4l2-ctl --list-formats-ext -d DEVICE' tells");
  v4l2_format wanted{};
  wanted.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  v4l2_pix_format& image = wanted.fmt.pix;
  image.width = static_cast<std::uint32_t>(format.width);
  image.height = static_cast<std::uint32_t>(format.height);
  image.pixelformat = format.pixels;
  image.field = V4L2_FIELD_NONE;
  control(VIDIOC_S_FMT, &wanted, "it takes no format");  // it changes what it does not have
  const int width = static_cast<int>(image.width), height = static_cast<int>(image.height);
  if (width != format.width || height != format.height || image.pixelformat != format.pixels)
    throw Error(Fault::kUsage,
                "it does not have " + format_text(format.pixels, format.width, format.height) +
                    ", but " + format_text(image.pixelformat, width, height),
                name_, "'v4l2-ctl --list-formats-ext -d " + name_ + "' lists what it has");
  stride_ = image.bytesperline;
  v4l2_streamparm rate{};
  rate.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  rate.parm.capture.timeperframe = {1, static_cast<std::uint32_t>(format.rate)};
  calls_.control(descriptor_, VIDIOC_S_PARM, &rate);  // some devices have one rate only
}

void V4l2Device::start() {
  share_buffers();
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  control(VIDIOC_STREAMON, &type, "the camera does not start");
}

void V4l2Device::share_buffers() {
  v4l2_requestbuffers request{};
  request.count = kBuffers;
  request.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  request.memory = V4L2_MEMORY_MMAP;
  control(VIDIOC_REQBUFS, &request, "it has no buffers for images");
  for (std::uint32_t i = 0; i < request.count; ++i) {
    v4l2_buffer buffer = capture_buffer(i);
    control(VIDIOC_QUERYBUF, &buffer, "it has no buffers for images");
    void* memory = calls_.map(descriptor_, buffer.length, static_cast<off_t>(buffer.m.offset));
    if (!memory)
      throw Error(Fault::kData, std::string("its buffers cannot be read: ") + std::strerror(errno),
                  name_);
    buffers_.push_back({memory, buffer.length});
    give_back(i);
  }
}

void V4l2Device::give_back(std::uint32_t index) {
  v4l2_buffer buffer = capture_buffer(index);
  control(VIDIOC_QBUF, &buffer, "the camera was unplugged");
}

std::size_t V4l2Device::take(const std::function<void(const V4l2Image&)>& use) {
  for (std::size_t damaged = 0;;) {
    v4l2_buffer buffer = capture_buffer();
    if (calls_.control(descriptor_, VIDIOC_DQBUF, &buffer) < 0) {
      if (errno == EAGAIN) return damaged;  // no more has come
      throw Error(Fault::kData, std::string("the camera was unplugged: ") + std::strerror(errno),
                  name_);
    }
    const Buffer& place = buffers_.at(buffer.index);
    const bool whole = !(buffer.flags & V4L2_BUF_FLAG_ERROR);
    const auto* bytes = static_cast<const std::uint8_t*>(place.memory);
    const auto& time = buffer.timestamp;
    if (whole)
      use({.bytes = {bytes, std::min<std::size_t>(buffer.bytesused, place.size)},
           .stride = stride_,
           .microseconds = static_cast<std::uint64_t>(time.tv_sec) * 1'000'000u +
                           static_cast<std::uint64_t>(time.tv_usec)});
    damaged += whole ? 0 : 1;
    give_back(buffer.index);
  }
}

}  // namespace stillpoint::source_video
