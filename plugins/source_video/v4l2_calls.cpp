#include "source_video/v4l2_calls.hpp"

#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>

namespace stillpoint::source_video {

int V4l2Calls::open(const char* device) { return ::open(device, O_RDWR | O_NONBLOCK | O_CLOEXEC); }

void V4l2Calls::close(int device) { ::close(device); }

int V4l2Calls::control(int device, unsigned long request, void* argument) {
  int result = 0;
  while ((result = ::ioctl(device, request, argument)) < 0 && errno == EINTR) continue;
  return result;
}

void* V4l2Calls::map(int device, std::size_t size, off_t offset) {
  void* memory = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, device, offset);
  return memory == MAP_FAILED ? nullptr : memory;
}

void V4l2Calls::unmap(void* memory, std::size_t size) { ::munmap(memory, size); }

void V4l2Calls::wait(std::span<pollfd> devices, std::chrono::milliseconds at_most) {
  ::poll(devices.data(), devices.size(), static_cast<int>(at_most.count()));
}

}  // namespace stillpoint::source_video
