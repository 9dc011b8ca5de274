#include "my_plugin.hpp"

#include <opencv2/imgproc.hpp>

namespace plugins::my_plugin {
namespace {

constexpr double kFramesPerSecond = 30.0;
constexpr int kTexels = 256;  // per metre

stillpoint::Camera camera_of(const stillpoint::StageContext& context) {
  if (context.camera) return context.camera->undistorted();
  return {.width = 320, .height = 240, .fx = 262.5, .fy = 262.5, .cx = 159.5, .cy = 119.5};
}

/// Noise on two scales, so that there are corners near and far.
cv::Mat make_texture(std::uint64_t seed) {
  cv::RNG random(seed);
  cv::Mat fine(kTexels / 4, kTexels / 4, CV_8UC3), coarse(kTexels / 16, kTexels / 16, CV_8UC3);
  random.fill(fine, cv::RNG::UNIFORM, 0, 256);
  random.fill(coarse, cv::RNG::UNIFORM, 0, 256);
  const cv::Size size(kTexels, kTexels);
  cv::resize(fine, fine, size, 0, 0, cv::INTER_CUBIC);
  cv::resize(coarse, coarse, size, 0, 0, cv::INTER_CUBIC);
  cv::Mat texture;
  cv::addWeighted(fine, 0.5, coarse, 0.5, 0, texture);
  return texture;
}

}  // namespace

MyPlugin::MyPlugin(const Options& options, const stillpoint::StageContext& context)
    : options_(options),
      camera_(std::make_shared<const stillpoint::Camera>(camera_of(context))),
      texture_(make_texture(context.seed)) {}

std::optional<std::size_t> MyPlugin::size() const {
  return static_cast<std::size_t>(options_.frames);
}

std::optional<stillpoint::Frame> MyPlugin::next() {
  if (next_ >= static_cast<std::uint32_t>(options_.frames)) return std::nullopt;
  stillpoint::Frame frame{.index = next_, .time = next_ / kFramesPerSecond, .camera = camera_};
  ++next_;
  // The wall is parallel to the image: a pixel sees the texture at an affine function of its
  // position.
  const double x = options_.speed * frame.time;  // metres, of the camera
  const double scale_x = kTexels * options_.distance / camera_->fx;
  const double scale_y = kTexels * options_.distance / camera_->fy;
  const cv::Matx23d texel_from_pixel(scale_x, 0, kTexels * x - scale_x * camera_->cx,  //
                                     0, scale_y, -scale_y * camera_->cy);
  const cv::Size size(camera_->width, camera_->height);
  cv::warpAffine(texture_, frame.bgr, texel_from_pixel, size,
                 cv::INTER_LINEAR | cv::WARP_INVERSE_MAP, cv::BORDER_WRAP);
  cv::cvtColor(frame.bgr, frame.gray, cv::COLOR_BGR2GRAY);
  frame.depth = cv::Mat(size, CV_32FC1, cv::Scalar(options_.distance));
  return frame;
}

}  // namespace plugins::my_plugin

// What the library provides: the type `my_plugin`.
STILLPOINT_PLUGIN(my_plugin, "0.1.0",
                  stillpoint::provide<stillpoint::Source, plugins::my_plugin::MyPlugin>(
                      "my_plugin", "a textured wall that the camera moves along"));
