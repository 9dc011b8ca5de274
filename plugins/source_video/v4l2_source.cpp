#include "source_video/v4l2_source.hpp"

#include <linux/videodev2.h>

#include <array>

#include "source_video/v4l2_pixels.hpp"

namespace stillpoint::source_video {
namespace {

constexpr const char* kName = "V4L2";
constexpr double kTicksPerSecond = 1e6;
constexpr int kCounterBits = 64;
constexpr std::chrono::milliseconds kLongestWait(100);  // until a stop is noticed

const CameraModel& required_camera(const StageContext& context) {
  if (context.camera) return *context.camera;
  throw Error(Fault::kUsage, "no camera is given", "", "name a camera file with --camera");
}

std::uint32_t pixels_of(V4l2Source::ColorFormat format) {
  return format == V4l2Source::ColorFormat::kMjpeg ? V4L2_PIX_FMT_MJPEG : V4L2_PIX_FMT_YUYV;
}

std::uint32_t pixels_of(V4l2Source::DepthFormat format) {
  return format == V4l2Source::DepthFormat::kZ16 ? V4L2_PIX_FMT_Z16 : V4L2_PIX_FMT_Y16;
}

}  // namespace

void V4l2Source::Options::visit(OptionVisitor& v) {
  v("color_device", color_device, {.help = "device that sends the colour images"});
  v("depth_device", depth_device,
    {.help = "device that sends the depth images, which it has registered to colour"});
  v.choice("color_format", color_format,
           {{"mjpeg", ColorFormat::kMjpeg}, {"yuyv", ColorFormat::kYuyv}},
           {.help = "how the device sends colour"});
  v.choice("depth_format", depth_format, {{"z16", DepthFormat::kZ16}, {"y16", DepthFormat::kY16}},
           {.help = "how the device sends depth"});
  v("rate", rate, {.min = 1, .max = 300, .unit = "Hz", .help = "images per second"});
  live.visit(v);
}

V4l2Source::Devices::Devices(const Options& options, cv::Size size, V4l2Calls& calls)
    : color(options.color_device,
            {pixels_of(options.color_format), size.width, size.height, options.rate}, calls),
      depth(options.depth_device,
            {pixels_of(options.depth_format), size.width, size.height, options.rate}, calls) {}

V4l2Source::V4l2Source(const Options& options, const StageContext& context,
                       std::shared_ptr<V4l2Calls> calls)
    : options_(options),
      calls_(std::move(calls)),
      size_(required_camera(context).width, required_camera(context).height),
      devices_(std::in_place, options, size_, *calls_),
      frames_(options.live, *context.camera, kName, kTicksPerSecond, kCounterBits, context.log) {}

V4l2Source::~V4l2Source() { V4l2Source::close(); }

// The thread ends before the devices are closed.
void V4l2Source::close() {
  if (thread_.joinable()) {
    thread_.request_stop();
    thread_.join();
  }
  devices_.reset();
}

void V4l2Source::start() {
  if (!devices_) devices_.emplace(options_, size_, *calls_);
  devices_->color.start();
  devices_->depth.start();
  thread_ = std::jthread([this](std::stop_token stop) { read(std::move(stop)); });
}

void V4l2Source::read(std::stop_token stop) {
  while (!stop.stop_requested()) {
    std::array<pollfd, 2> ready{
        {{devices_->color.descriptor(), POLLIN, 0}, {devices_->depth.descriptor(), POLLIN, 0}}};
    calls_->wait(ready, kLongestWait);
    try {
      take_images();
    } catch (const Error& gone) {
      frames_.end(gone.what());
      return;
    }
  }
}

void V4l2Source::take_images() {
  damaged_ += devices_->color.take([&](const V4l2Image& image) {
    const cv::Mat bgr = bgr_of(image, pixels_of(options_.color_format), size_);
    if (bgr.empty())
      ++damaged_;
    else
      frames_.put_color(image.microseconds, bgr);
  });
  damaged_ += devices_->depth.take([&](const V4l2Image& image) {
    const cv::Mat depth = depth_of(image, size_);
    if (depth.empty())
      ++damaged_;
    else
      frames_.put_depth(image.microseconds, depth);
  });
}

std::size_t V4l2Source::left_out() const { return frames_.left_out() + damaged_; }

SourceReport V4l2Source::report() const {
  SourceReport report = frames_.report();
  report.skipped += damaged_;
  if (damaged_ > 0)
    report.warnings.push_back(std::string(kName) + ": " + std::to_string(damaged_) +
                              " images came damaged");
  return report;
}

}  // namespace stillpoint::source_video
