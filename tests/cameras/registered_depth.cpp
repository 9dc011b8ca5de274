// Preloaded before Debian's fakenect, which plays depth images as they are stored, but only knows
// the raw format by name: those of the test are registered and in millimetres.
#include <libfreenect.h>

extern "C" {

__attribute__((visibility("default"))) freenect_frame_mode freenect_find_depth_mode(
    freenect_resolution resolution, freenect_depth_format format) {
  freenect_frame_mode mode{};
  mode.resolution = resolution;
  mode.depth_format = format;
  mode.bytes = 640 * 480 * 2;
  mode.width = 640;
  mode.height = 480;
  mode.data_bits_per_pixel = 16;
  mode.framerate = 30;
  mode.is_valid = 1;
  return mode;
}

__attribute__((visibility("default"))) int freenect_set_depth_mode(freenect_device*,
                                                                   freenect_frame_mode) {
  return 0;
}
}
