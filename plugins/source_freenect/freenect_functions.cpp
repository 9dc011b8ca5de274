// The functions of libfreenect that this plugin calls, from a library that the first of them loads.
#include <libfreenect.h>

#include "live_camera/driver_library.hpp"

namespace {

const stillpoint::live_camera::DriverLibrary& freenect() {
  static const stillpoint::live_camera::DriverLibrary library("libfreenect.so.0.5",
                                                              "libfreenect0.5");
  return library;
}

}  // namespace

#define FORWARD(name, parameters, arguments) \
  STILLPOINT_FORWARD_TO_DRIVER(freenect, name, parameters, arguments)

FORWARD(freenect_init, (freenect_context * *context, freenect_usb_context* usb), (context, usb))
FORWARD(freenect_shutdown, (freenect_context * context), (context))
FORWARD(freenect_set_log_level, (freenect_context * context, freenect_loglevel level),
        (context, level))
FORWARD(freenect_select_subdevices, (freenect_context * context, freenect_device_flags devices),
        (context, devices))
FORWARD(freenect_num_devices, (freenect_context * context), (context))
FORWARD(freenect_process_events_timeout, (freenect_context * context, timeval* timeout),
        (context, timeout))

FORWARD(freenect_open_device, (freenect_context * context, freenect_device** device, int index),
        (context, device, index))
FORWARD(freenect_open_device_by_camera_serial,
        (freenect_context * context, freenect_device** device, const char* serial),
        (context, device, serial))
FORWARD(freenect_close_device, (freenect_device * device), (device))
FORWARD(freenect_set_user, (freenect_device * device, void* user), (device, user))
FORWARD(freenect_get_user, (freenect_device * device), (device))

FORWARD(freenect_find_video_mode, (freenect_resolution resolution, freenect_video_format format),
        (resolution, format))
FORWARD(freenect_set_video_mode, (freenect_device * device, freenect_frame_mode mode),
        (device, mode))
FORWARD(freenect_set_video_callback, (freenect_device * device, freenect_video_cb callback),
        (device, callback))
FORWARD(freenect_start_video, (freenect_device * device), (device))
FORWARD(freenect_stop_video, (freenect_device * device), (device))

FORWARD(freenect_find_depth_mode, (freenect_resolution resolution, freenect_depth_format format),
        (resolution, format))
FORWARD(freenect_set_depth_mode, (freenect_device * device, freenect_frame_mode mode),
        (device, mode))
FORWARD(freenect_set_depth_callback, (freenect_device * device, freenect_depth_cb callback),
        (device, callback))
FORWARD(freenect_start_depth, (freenect_device * device), (device))
FORWARD(freenect_stop_depth, (freenect_device * device), (device))

#undef FORWARD
