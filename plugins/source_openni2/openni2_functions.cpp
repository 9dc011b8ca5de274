// The C functions that the inline classes of OpenNI 2 call, from a library that the first of them
// loads.
#include <OpenNI.h>

#include "live_camera/driver_library.hpp"

namespace {

const stillpoint::live_camera::DriverLibrary& openni2() {
  static const stillpoint::live_camera::DriverLibrary library("libOpenNI2.so.0", "libopenni2-0");
  return library;
}

}  // namespace

#define FORWARD(name, parameters, arguments) \
  STILLPOINT_FORWARD_TO_DRIVER(openni2, name, parameters, arguments)

FORWARD(oniInitialize, (int version), (version))
FORWARD(oniGetExtendedError, (), ())
FORWARD(oniGetDeviceList, (OniDeviceInfo * *devices, int* count), (devices, count))
FORWARD(oniReleaseDeviceList, (OniDeviceInfo * devices), (devices))
FORWARD(oniRegisterDeviceCallbacks,
        (OniDeviceCallbacks * callbacks, void* cookie, OniCallbackHandle* handle),
        (callbacks, cookie, handle))
FORWARD(oniUnregisterDeviceCallbacks, (OniCallbackHandle handle), (handle))
FORWARD(oniWaitForAnyStream, (OniStreamHandle * streams, int count, int* ready, int timeout),
        (streams, count, ready, timeout))

FORWARD(oniDeviceOpen, (const char* uri, OniDeviceHandle* device), (uri, device))
FORWARD(oniDeviceClose, (OniDeviceHandle device), (device))
FORWARD(oniDeviceGetInfo, (OniDeviceHandle device, OniDeviceInfo* info), (device, info))
FORWARD(oniDeviceIsPropertySupported, (OniDeviceHandle device, int property), (device, property))
FORWARD(oniDeviceSetProperty, (OniDeviceHandle device, int property, const void* data, int size),
        (device, property, data, size))
FORWARD(oniDeviceIsCommandSupported, (OniDeviceHandle device, int command), (device, command))
FORWARD(oniDeviceEnableDepthColorSync, (OniDeviceHandle device), (device))
FORWARD(oniDeviceCreateStream,
        (OniDeviceHandle device, OniSensorType sensor, OniStreamHandle* stream),
        (device, sensor, stream))

FORWARD(oniStreamDestroy, (OniStreamHandle stream), (stream))
FORWARD(oniStreamGetSensorInfo, (OniStreamHandle stream), (stream))
FORWARD(oniStreamIsPropertySupported, (OniStreamHandle stream, int property), (stream, property))
FORWARD(oniStreamGetProperty, (OniStreamHandle stream, int property, void* data, int* size),
        (stream, property, data, size))
FORWARD(oniStreamSetProperty, (OniStreamHandle stream, int property, const void* data, int size),
        (stream, property, data, size))
FORWARD(oniStreamStart, (OniStreamHandle stream), (stream))
FORWARD(oniStreamStop, (OniStreamHandle stream), (stream))
FORWARD(oniStreamReadFrame, (OniStreamHandle stream, OniFrame** frame), (stream, frame))
FORWARD(oniFrameRelease, (OniFrame * frame), (frame))

#undef FORWARD
