// Frames of a camera whose colour and depth are two devices of V4L2.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "live_camera/live_frames.hpp"
#include "source_video/v4l2_calls.hpp"
#include "source_video/v4l2_device.hpp"
#include "stillpoint/sdk.hpp"

namespace stillpoint::source_video {

/// Sizes and the unit of depth are those of the camera, which has to be given; depth has to be
/// registered to colour by the device. The camera sends from the first call of next() on. Throws
/// Error(kData) without a camera, and when it sends nothing any more and is not back in time.
class V4l2Source final : public Source, private live_camera::LiveDriver {
 public:
  enum class ColorFormat { kMjpeg, kYuyv };
  enum class DepthFormat { kZ16, kY16 };
  struct Options {
    std::string color_device = "/dev/video0";
    std::string depth_device = "/dev/video2";
    ColorFormat color_format = ColorFormat::kYuyv;
    DepthFormat depth_format = DepthFormat::kZ16;
    int rate = 30;  ///< Hz
    live_camera::LiveOptions live;

    void visit(OptionVisitor& visitor);
  };

  V4l2Source(const Options& options, const StageContext& context,
             std::shared_ptr<V4l2Calls> calls = std::make_shared<V4l2Calls>());
  ~V4l2Source() override;

  void begin(std::stop_token stop) override { frames_.begin(std::move(stop)); }
  std::optional<Frame> next() override { return frames_.next(*this); }
  std::size_t left_out() const override;
  SourceReport report() const override;

 private:
  struct Devices {
    Devices(const Options& options, cv::Size size, V4l2Calls& calls);
    V4l2Device color, depth;
  };

  void start() override;
  void close() override;
  void read(std::stop_token stop);  // on the thread
  void take_images();               // on the thread

  const Options options_;
  const std::shared_ptr<V4l2Calls> calls_;
  const cv::Size size_;
  std::optional<Devices> devices_;
  live_camera::LiveFrames frames_;
  std::atomic<std::size_t> damaged_ = 0;  // images
  std::jthread thread_;                   // last: it uses all the others
};

}  // namespace stillpoint::source_video
