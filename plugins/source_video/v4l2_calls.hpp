// The calls of the system that V4L2, Linux's interface to cameras, consists of.
#pragma once

#include <poll.h>
#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <span>

namespace stillpoint::source_video {

/// Results and errno are those of the system's functions. Tests put a camera in their place.
class V4l2Calls {
 public:
  virtual ~V4l2Calls() = default;
  virtual int open(const char* device);
  virtual void close(int device);
  /// Called again when a signal interrupts it.
  virtual int control(int device, unsigned long request, void* argument);
  /// Null when it fails.
  virtual void* map(int device, std::size_t size, off_t offset);
  virtual void unmap(void* memory, std::size_t size);
  /// Until one of them has something to say.
  virtual void wait(std::span<pollfd> devices, std::chrono::milliseconds at_most);
};

}  // namespace stillpoint::source_video
