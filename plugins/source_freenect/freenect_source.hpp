// Frames of a Kinect of the first generation.
#pragma once

#include <libfreenect.h>

#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "live_camera/live_frames.hpp"
#include "stillpoint/sdk.hpp"

namespace stillpoint::source_freenect {

/// 640 x 480 pixels at 30 Hz, depth registered to colour by the driver. The camera sends from the
/// first call of next() on. Throws Error(kData) without a camera, and when it sends nothing any
/// more and is not back in time.
class FreenectSource final : public Source, private live_camera::LiveDriver {
 public:
  struct Options {
    std::string serial;  ///< of the camera; empty: the first one
    live_camera::LiveOptions live;

    void visit(OptionVisitor& visitor);
  };

  FreenectSource(const Options& options, const StageContext& context);
  ~FreenectSource() override;

  void begin(std::stop_token stop) override { frames_.begin(std::move(stop)); }
  std::optional<Frame> next() override { return frames_.next(*this); }
  std::size_t left_out() const override { return frames_.left_out(); }
  SourceReport report() const override { return frames_.report(); }

 private:
  /// The device, not started yet.
  class Kinect {
   public:
    explicit Kinect(const std::string& serial);
    freenect_context* context() const { return context_.get(); }
    freenect_device* device() const { return device_.get(); }

   private:
    struct Shutdown {
      void operator()(freenect_context* context) const { freenect_shutdown(context); }
    };
    struct Close {
      void operator()(freenect_device* device) const { freenect_close_device(device); }
    };
    std::unique_ptr<freenect_context, Shutdown> context_;
    std::unique_ptr<freenect_device, Close> device_;
  };

  void start() override;
  void close() override;
  void process_events(std::stop_token stop);  // on the driver's thread

  const std::string serial_;
  std::optional<Kinect> kinect_;
  live_camera::LiveFrames frames_;
  std::jthread thread_;  // last: it uses all the others
};

}  // namespace stillpoint::source_freenect
