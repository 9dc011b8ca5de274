// Frames of a camera with an OpenNI 2 driver.
#pragma once

#include <OpenNI.h>

#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "live_camera/live_frames.hpp"
#include "stillpoint/sdk.hpp"

namespace stillpoint::source_openni2 {

/// Depth is registered to colour by the device. The camera sends from the first call of next() on.
/// Throws Error(kData) without a camera, and when it sends nothing any more and is not back in
/// time.
class OpenNi2Source final : public Source, private live_camera::LiveDriver {
 public:
  struct Options {
    std::string device;         ///< URI; empty: the first one
    int width = 640;            ///< px
    int height = 480;           ///< px
    int rate = 30;              ///< Hz
    bool auto_exposure = true;  ///< also of the white balance
    live_camera::LiveOptions live;

    void visit(OptionVisitor& visitor);
  };

  OpenNi2Source(const Options& options, const StageContext& context);
  ~OpenNi2Source() override;

  void begin(std::stop_token stop) override { frames_.begin(std::move(stop)); }
  std::optional<Frame> next() override { return frames_.next(*this); }
  std::size_t left_out() const override { return frames_.left_out(); }
  SourceReport report() const override { return frames_.report(); }

 private:
  /// The device with both streams, not started yet.
  struct Camera {
    explicit Camera(const Options& options);

    openni::Device device;
    openni::VideoStream color, depth;
    std::string name;
    bool registered;  ///< by the device
  };
  /// Tells `frames` that the device is gone.
  struct Disconnection final : openni::OpenNI::DeviceDisconnectedListener {
    Disconnection(std::string uri, live_camera::LiveFrames& frames);
    ~Disconnection() override;
    void onDeviceDisconnected(const openni::DeviceInfo* device) override;

    std::string uri;
    live_camera::LiveFrames& frames;
  };

  void start() override;
  void close() override;
  void read(std::stop_token stop);  // on the thread

  const Options options_;
  std::optional<Camera> camera_;
  live_camera::LiveFrames frames_;
  std::optional<Disconnection> disconnection_;
  std::jthread thread_;  // last: it uses all the others
};

}  // namespace stillpoint::source_openni2
