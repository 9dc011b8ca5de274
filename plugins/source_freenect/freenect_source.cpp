#include "source_freenect/freenect_source.hpp"

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "live_camera/driver_library.hpp"

namespace stillpoint::source_freenect {
namespace {

using live_camera::LiveFrames;

constexpr int kWidth = 640;
constexpr int kHeight = 480;
constexpr double kTicksPerSecond = 60e6;  // of the Kinect's counter
constexpr int kCounterBits = 32;
// Of the colour camera: a focal length of 525 px, the one that drivers assume.
constexpr double kFieldOfView = 1.0946;  // rad
constexpr const char* kDevice = "Kinect";

// On the driver's thread. Its buffers are used again for the next images.
void color_came(freenect_device* device, void* rgb, std::uint32_t ticks) {
  cv::Mat bgr;
  cv::cvtColor(cv::Mat(kHeight, kWidth, CV_8UC3, rgb), bgr, cv::COLOR_RGB2BGR);
  static_cast<LiveFrames*>(freenect_get_user(device))->put_color(ticks, bgr);
}

void depth_came(freenect_device* device, void* millimetres, std::uint32_t ticks) {
  const cv::Mat depth(kHeight, kWidth, CV_16UC1, millimetres);
  static_cast<LiveFrames*>(freenect_get_user(device))->put_depth(ticks, depth.clone());
}

}  // namespace

void FreenectSource::Options::visit(OptionVisitor& v) {
  v("serial", serial, {.help = "serial number of the camera; empty for the first one"});
  live.visit(v);
}

FreenectSource::Kinect::Kinect(const std::string& serial) {
  freenect_context* context = nullptr;
  if (freenect_init(&context, nullptr) < 0)
    throw Error(Fault::kData, "libfreenect cannot use the USB bus", kDevice);
  context_.reset(context);
  freenect_set_log_level(context, FREENECT_LOG_FATAL);
  freenect_select_subdevices(context, FREENECT_DEVICE_CAMERA);
  if (freenect_num_devices(context) <= 0)
    throw Error(Fault::kData, "no camera is connected", kDevice,
                "a Kinect needs its own power supply; list the USB devices with lsusb");
  freenect_device* device = nullptr;
  const int failed = serial.empty()
                         ? freenect_open_device(context, &device, 0)
                         : freenect_open_device_by_camera_serial(context, &device, serial.c_str());
  if (failed < 0)
    throw Error(Fault::kData,
                serial.empty() ? "the camera cannot be opened"
                               : "no camera with the serial number " + serial + " can be opened",
                kDevice, "end other programs that use it, and see whether you may use the device");
  device_.reset(device);
}

FreenectSource::FreenectSource(const Options& options, const StageContext& context)
    : serial_(options.serial),
      kinect_(std::in_place, serial_),
      frames_(options.live,
              live_camera::live_model(context, kDevice, kWidth, kHeight, kFieldOfView), kDevice,
              kTicksPerSecond, kCounterBits, context.log) {}

FreenectSource::~FreenectSource() { FreenectSource::close(); }

// The thread ends before the camera is closed.
void FreenectSource::close() {
  if (thread_.joinable()) {
    thread_.request_stop();
    thread_.join();
    live_camera::undo_in_driver([this] {
      freenect_stop_video(kinect_->device());
      freenect_stop_depth(kinect_->device());
    });
  }
  kinect_.reset();
}

void FreenectSource::start() {
  if (!kinect_) kinect_.emplace(serial_);
  freenect_device* device = kinect_->device();
  freenect_set_user(device, &frames_);
  freenect_set_video_callback(device, color_came);
  freenect_set_depth_callback(device, depth_came);
  const auto video = freenect_find_video_mode(FREENECT_RESOLUTION_MEDIUM, FREENECT_VIDEO_RGB);
  const auto depth =
      freenect_find_depth_mode(FREENECT_RESOLUTION_MEDIUM, FREENECT_DEPTH_REGISTERED);
  if (freenect_set_video_mode(device, video) < 0 || freenect_set_depth_mode(device, depth) < 0 ||
      freenect_start_video(device) < 0 || freenect_start_depth(device) < 0)
    throw Error(Fault::kData, "the camera does not start", kDevice,
                "unplug it and plug it in again; it needs a USB 2 port of its own");
  thread_ = std::jthread([this](std::stop_token stop) { process_events(std::move(stop)); });
}

void FreenectSource::process_events(std::stop_token stop) {
  while (!stop.stop_requested()) {
    timeval timeout{.tv_sec = 0, .tv_usec = 100'000};
    if (freenect_process_events_timeout(kinect_->context(), &timeout) >= 0) continue;
    frames_.end("the camera was unplugged");
    return;
  }
}

}  // namespace stillpoint::source_freenect
