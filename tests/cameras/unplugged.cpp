// Preloaded before the drivers' stand-ins, fakenect and OpenNI's DummyDevice, which are always
// there: pulls the cable once, or lets the camera hang.
//   STILLPOINT_UNPLUG_AFTER=N  after N images the driver fails; the camera is found again at the
//                              second attempt
//   STILLPOINT_STALL_AFTER=N   after N images no more come
#include <dlfcn.h>
#include <libfreenect.h>
#include <sys/select.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#if __has_include(<OniCAPI.h>)
#define HAS_OPENNI
#include <OniCAPI.h>
#endif

namespace {

enum class Cable { kPlugged, kPulled, kPluggedAgain };

std::atomic<int> images = 0;
std::atomic<int> attempts = 0;
std::atomic<Cable> cable = Cable::kPlugged;

bool after(const char* variable) {
  const char* count = std::getenv(variable);
  return count && images >= std::atoi(count);
}

bool is_away() {
  Cable plugged = Cable::kPlugged;
  if (after("STILLPOINT_UNPLUG_AFTER")) cable.compare_exchange_strong(plugged, Cable::kPulled);
  return cable == Cable::kPulled;
}

/// Of an attempt to open the camera.
bool is_found() {
  if (!is_away()) return true;
  if (++attempts > 1) cable = Cable::kPluggedAgain;
  return !is_away();
}

template <class Function>
Function* of_driver(const char* library, const char* name) {
  return reinterpret_cast<Function*>(dlsym(dlopen(library, RTLD_NOW | RTLD_NOLOAD), name));
}

constexpr const char* kFreenect = "libfreenect.so.0.5";
#ifdef HAS_OPENNI
constexpr const char* kOpenNi = "libOpenNI2.so.0";
#endif

}  // namespace

extern "C" {

__attribute__((visibility("default"))) int freenect_num_devices(freenect_context*) {
  return is_found() ? 1 : 0;
}

__attribute__((visibility("default"))) int freenect_process_events_timeout(
    freenect_context* context, timeval* timeout) {
  if (is_away()) return -1;
  if (after("STILLPOINT_STALL_AFTER")) {
    static const int said = std::fputs("the camera hangs\n", stderr);
    static_cast<void>(said);
    select(0, nullptr, nullptr, nullptr, timeout);
    return 0;
  }
  static auto* const real =
      of_driver<int(freenect_context*, timeval*)>(kFreenect, "freenect_process_events_timeout");
  ++images;
  return real(context, timeout);
}

#ifdef HAS_OPENNI
__attribute__((visibility("default"))) OniStatus oniDeviceOpen(const char* uri,
                                                               OniDeviceHandle* device) {
  if (!is_found()) return ONI_STATUS_NO_DEVICE;
  static auto* const real =
      of_driver<OniStatus(const char*, OniDeviceHandle*)>(kOpenNi, "oniDeviceOpen");
  return real(uri, device);
}

__attribute__((visibility("default"))) OniStatus oniStreamReadFrame(OniStreamHandle stream,
                                                                    OniFrame** frame) {
  if (is_away()) return ONI_STATUS_ERROR;
  static auto* const real =
      of_driver<OniStatus(OniStreamHandle, OniFrame**)>(kOpenNi, "oniStreamReadFrame");
  ++images;
  return real(stream, frame);
}
#endif
}
