#include "source_openni2/openni2_source.hpp"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <thread>
#include <utility>

#include "live_camera/driver_library.hpp"

namespace stillpoint::source_openni2 {
namespace {

using openni::OpenNI;
using openni::VideoFrameRef;
using openni::VideoMode;
using openni::VideoStream;

constexpr double kTicksPerSecond = 1e6;
constexpr int kCounterBits = 64;
// stop() of the driver DummyDevice does not wait for the thread of the stream, which wakes up once
// more, 33 ms later, and must still find it: three times that, for a busy machine.
constexpr std::chrono::milliseconds kLastFrameOfDriver(100);

/// Throws with what OpenNI says unless `status` is that of success.
void require(openni::Status status, const std::string& what, const std::string& device) {
  if (status == openni::STATUS_OK) return;
  std::string reason = OpenNI::getExtendedError();  // ends with a newline, if there is one
  reason.erase(reason.find_last_not_of(" \n\t") + 1);
  throw Error(Fault::kData, what + (reason.empty() ? "" : ": " + reason), device,
              "end other programs that use it, and see whether you may use the device");
}

/// OpenNI is not shut down again: it would unload drivers whose threads may still run.
void initialize() { require(OpenNI::initialize(), "OpenNI 2 cannot be initialised", "OpenNI 2"); }

/// OpenNI 2.2.0.33 would open a recording, and hang when it plays it.
void refuse_recording(const std::string& device) {
  constexpr std::size_t kLength = 4;
  std::string ending = device.substr(device.size() - std::min(device.size(), kLength));
  std::ranges::transform(ending, ending.begin(), [](unsigned char letter) {
    return static_cast<char>(std::tolower(letter));
  });
  if (ending == ".oni")
    throw Error(Fault::kUsage, "is a recording of OpenNI, which this source does not play", device,
                "convert it to a folder of the TUM format or to a bag, and give that with "
                "--dataset; 'stillpoint record' makes such folders of a live camera");
}

std::string uri_of(const openni::Device& device) { return device.getDeviceInfo().getUri(); }

std::string text_of(int width, int height, int rate) {
  return std::to_string(width) + " x " + std::to_string(height) + " at " + std::to_string(rate) +
         " Hz";
}

bool is(const VideoMode& mode, openni::PixelFormat format, const OpenNi2Source::Options& options) {
  return mode.getPixelFormat() == format && mode.getResolutionX() == options.width &&
         mode.getResolutionY() == options.height && mode.getFps() == options.rate;
}

/// Of the stream, with this pixel format.
[[noreturn]] void refuse(const VideoStream& stream, openni::PixelFormat format,
                         const OpenNi2Source::Options& options, const std::string& kind,
                         const std::string& name) {
  const auto& modes = stream.getSensorInfo().getSupportedVideoModes();
  std::string supported;
  for (int i = 0; i < modes.getSize(); ++i)
    if (modes[i].getPixelFormat() == format)
      supported += (supported.empty() ? ", but " : ", ") +
                   text_of(modes[i].getResolutionX(), modes[i].getResolutionY(), modes[i].getFps());
  throw Error(Fault::kUsage,
              "it has no " + kind + " images of " +
                  text_of(options.width, options.height, options.rate) + supported,
              name, "set width, height and rate of the source");
}

void create(VideoStream& stream, const openni::Device& device, openni::SensorType sensor,
            openni::PixelFormat format, const OpenNi2Source::Options& options,
            const std::string& name) {
  const std::string kind = sensor == openni::SENSOR_COLOR ? "colour" : "depth";
  require(stream.create(device, sensor), "the camera has no " + kind + " images", name);
  if (!is(stream.getVideoMode(), format, options)) {
    const auto& modes = stream.getSensorInfo().getSupportedVideoModes();
    int i = 0;
    while (i < modes.getSize() && !is(modes[i], format, options)) ++i;
    if (i == modes.getSize()) refuse(stream, format, options, kind, name);
    require(stream.setVideoMode(modes[i]), "the camera refuses this kind of " + kind + " images",
            name);
  }
  stream.setMirroringEnabled(false);
}

cv::Mat pixels_of(const VideoFrameRef& frame, int type) {
  return {frame.getHeight(), frame.getWidth(), type, const_cast<void*>(frame.getData()),
          static_cast<std::size_t>(frame.getStrideInBytes())};
}

}  // namespace

void OpenNi2Source::Options::visit(OptionVisitor& v) {
  v("device", device, {.help = "URI of the camera; empty for the first one"});
  v("width", width, {.min = 16, .max = 4096, .unit = "px", .help = "width of the images"});
  v("height", height, {.min = 16, .max = 4096, .unit = "px", .help = "height of the images"});
  v("rate", rate, {.min = 1, .max = 300, .unit = "Hz", .help = "images per second"});
  v("auto_exposure", auto_exposure,
    {.help = "let the camera adjust exposure and white balance to the scene"});
  live.visit(v);
}

OpenNi2Source::Camera::Camera(const Options& options) {
  refuse_recording(options.device);
  initialize();
  const bool any = options.device.empty();
  const std::string wanted = any ? "OpenNI 2" : options.device;
  openni::Array<openni::DeviceInfo> connected;
  OpenNI::enumerateDevices(&connected);
  if (any && connected.getSize() == 0)
    throw Error(Fault::kData, "no camera is connected", wanted,
                "list the USB devices with lsusb; a Kinect v1 needs the source 'freenect'");
  require(device.open(any ? openni::ANY_DEVICE : options.device.c_str()),
          "the camera cannot be opened", wanted);
  name = device.getDeviceInfo().getName();
  if (name.empty()) name = uri_of(device);
  create(color, device, openni::SENSOR_COLOR, openni::PIXEL_FORMAT_RGB888, options, name);
  create(depth, device, openni::SENSOR_DEPTH, openni::PIXEL_FORMAT_DEPTH_1_MM, options, name);
  registered = device.setImageRegistrationMode(openni::IMAGE_REGISTRATION_DEPTH_TO_COLOR) ==
               openni::STATUS_OK;
  device.setDepthColorSyncEnabled(true);  // some devices cannot; pairs are made by time anyway
  if (openni::CameraSettings* settings = color.getCameraSettings()) {
    settings->setAutoExposureEnabled(options.auto_exposure);
    settings->setAutoWhiteBalanceEnabled(options.auto_exposure);
  }
}

OpenNi2Source::Disconnection::Disconnection(std::string device_uri,
                                            live_camera::LiveFrames& live_frames)
    : uri(std::move(device_uri)), frames(live_frames) {
  OpenNI::addDeviceDisconnectedListener(this);
}

OpenNi2Source::Disconnection::~Disconnection() {
  live_camera::undo_in_driver([this] { OpenNI::removeDeviceDisconnectedListener(this); });
}

void OpenNi2Source::Disconnection::onDeviceDisconnected(const openni::DeviceInfo* device) {
  if (uri == device->getUri()) frames.end("the camera was unplugged");
}

OpenNi2Source::OpenNi2Source(const Options& options, const StageContext& context)
    : options_(options),
      camera_(std::in_place, options),
      frames_(options.live,
              live_camera::live_model(context, camera_->name, options.width, options.height,
                                      camera_->color.getHorizontalFieldOfView()),
              camera_->name, kTicksPerSecond, kCounterBits, context.log) {
  if (!camera_->registered)
    context.log(LogLevel::kWarning,
                camera_->name +
                    ": the device does not register depth to colour; unless both have the "
                    "same view, the estimate will be poor");
}

OpenNi2Source::~OpenNi2Source() { OpenNi2Source::close(); }

// The thread ends before the streams are stopped.
void OpenNi2Source::close() {
  if (thread_.joinable()) {
    thread_.request_stop();
    thread_.join();
    live_camera::undo_in_driver([this] {
      camera_->color.stop();
      camera_->depth.stop();
      if (uri_of(camera_->device) == "Dummy") std::this_thread::sleep_for(kLastFrameOfDriver);
    });
  }
  disconnection_.reset();
  camera_.reset();
}

// A camera that was plugged in again may have another URI.
void OpenNi2Source::start() {
  if (!camera_) camera_.emplace(options_);
  disconnection_.emplace(uri_of(camera_->device), frames_);
  require(camera_->color.start(), "the camera does not start", camera_->name);
  require(camera_->depth.start(), "the camera does not start", camera_->name);
  thread_ = std::jthread([this](std::stop_token stop) { read(std::move(stop)); });
}

void OpenNi2Source::read(std::stop_token stop) {
  constexpr int kTimeout = 100;  // ms
  VideoStream* streams[] = {&camera_->color, &camera_->depth};
  while (!stop.stop_requested()) {
    int ready = 0;
    VideoFrameRef frame;
    const openni::Status waited = OpenNI::waitForAnyStream(streams, 2, &ready, kTimeout);
    if (waited == openni::STATUS_TIME_OUT) continue;
    if (waited != openni::STATUS_OK || streams[ready]->readFrame(&frame) != openni::STATUS_OK) {
      frames_.end("the camera sends no more images");
      return;
    }
    if (streams[ready] == &camera_->color) {
      cv::Mat bgr;
      cv::cvtColor(pixels_of(frame, CV_8UC3), bgr, cv::COLOR_RGB2BGR);
      frames_.put_color(frame.getTimestamp(), bgr);
    } else {
      frames_.put_depth(frame.getTimestamp(), pixels_of(frame, CV_16UC1).clone());
    }
  }
}

}  // namespace stillpoint::source_openni2
