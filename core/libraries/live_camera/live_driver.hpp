// What a driver does for the frames of its camera.
#pragma once

namespace stillpoint::live_camera {

/// A camera that LiveFrames has opened, and opened again when it was away. One thread at a time.
class LiveDriver {
 public:
  virtual ~LiveDriver() = default;

  /// Opens the camera, unless it is open, and has it send images: from then on they are put into
  /// LiveFrames, on a thread of the driver. Throws Error when the camera is not there or refuses.
  virtual void start() = 0;
  /// Closes the camera, in whatever state it is: when this returns, no more images are put in.
  virtual void close() = 0;
};

}  // namespace stillpoint::live_camera
