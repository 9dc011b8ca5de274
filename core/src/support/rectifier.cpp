#include "stillpoint/support/rectifier.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "stillpoint/error.hpp"
#include "stillpoint/support/option_check.hpp"
#include "stillpoint/support/size_text.hpp"

namespace stillpoint {
namespace {

bool is_distorted(const CameraModel& model) {
  return std::any_of(model.distortion.begin(), model.distortion.end(),
                     [](double k) { return k != 0.0; });
}

cv::Rect crop_of(const CameraModel& model) {
  if (model.crop.size() != 4) return {0, 0, model.width, model.height};
  return {static_cast<int>(model.crop[0]), static_cast<int>(model.crop[1]),
          static_cast<int>(model.crop[2]), static_cast<int>(model.crop[3])};
}

/// Source position (CV_32FC1 x and y) of every pixel of the undistorted and cropped image.
void undistortion_map(const CameraModel& model, const Camera& camera, cv::Mat& x, cv::Mat& y) {
  const cv::Matx33d recorded(model.fx, 0, model.cx, 0, model.fy, model.cy, 0, 0, 1);
  const cv::Matx33d ideal(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
  cv::initUndistortRectifyMap(recorded, model.distortion, cv::noArray(), ideal,
                              {camera.width, camera.height}, CV_32FC1, x, y);
}

std::vector<int> nearest_pixels(const cv::Mat& x, const cv::Mat& y, const CameraModel& model) {
  std::vector<int> indices(x.total());
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const int u = cvRound(x.at<float>(static_cast<int>(i)));
    const int v = cvRound(y.at<float>(static_cast<int>(i)));
    const bool inside = u >= 0 && v >= 0 && u < model.width && v < model.height;
    indices[i] = inside ? v * model.width + u : -1;
  }
  return indices;
}

/// Limits what follows can rely on: a crop inside the image, for one.
const CameraModel& checked(const CameraModel& model) {
  check_options(model, "camera '" + model.name + "'");
  return model;
}

std::vector<float> metres_of_raw(const CameraModel& model) {
  std::vector<float> metres(65536, 0.0F);
  const double nearest = std::ceil(std::min(model.min_depth * model.depth_factor, 65536.0));
  const double farthest = std::min(model.max_depth * model.depth_factor, 65535.0);
  const auto factor = static_cast<float>(model.depth_factor);
  for (int raw = std::max(1, static_cast<int>(nearest)); raw <= static_cast<int>(farthest); ++raw)
    metres[static_cast<std::size_t>(raw)] = static_cast<float>(raw) / factor;
  return metres;
}

}  // namespace

CameraModel rectified(CameraModel sensor, const Camera& camera) {
  sensor.width = camera.width;
  sensor.height = camera.height;
  sensor.fx = camera.fx;
  sensor.fy = camera.fy;
  sensor.cx = camera.cx;
  sensor.cy = camera.cy;
  sensor.depth_noise = camera.depth_noise;
  sensor.surface_noise = camera.surface_noise;
  sensor.distortion.clear();
  sensor.crop.clear();
  return sensor;
}

Rectifier::Rectifier(const CameraModel& model)
    : model_(checked(model)),
      crop_(crop_of(model)),
      camera_(std::make_shared<const Camera>(model.undistorted())),
      metres_(metres_of_raw(model)) {
  if (!is_distorted(model)) return;
  cv::Mat x, y;
  undistortion_map(model, *camera_, x, y);
  cv::convertMaps(x, y, color_map_, color_weights_, CV_16SC2);
  depth_map_ = nearest_pixels(x.reshape(1, 1), y.reshape(1, 1), model);
}

Frame Rectifier::frame(double time, const cv::Mat& bgr, const cv::Mat& depth_image) const {
  check(bgr, "colour", {CV_8UC3});
  check(depth_image, "depth", {CV_16UC1, CV_32FC1});
  Frame frame{.time = time, .bgr = color(bgr), .camera = camera_};
  cv::cvtColor(frame.bgr, frame.gray, cv::COLOR_BGR2GRAY);
  frame.depth = depth(depth_image);
  return frame;
}

cv::Mat Rectifier::color(const cv::Mat& bgr) const {
  if (color_map_.empty()) return crop_.size() == bgr.size() ? bgr : bgr(crop_).clone();
  cv::Mat undistorted;
  cv::remap(bgr, undistorted, color_map_, color_weights_, cv::INTER_LINEAR, cv::BORDER_CONSTANT);
  return undistorted;
}

cv::Mat Rectifier::depth(const cv::Mat& recorded) const {
  if (recorded.type() == CV_16UC1)
    return rectified_depth<std::uint16_t>(recorded,
                                          [this](std::uint16_t raw) { return metres_[raw]; });
  const auto nearest = static_cast<float>(model_.min_depth);
  const auto farthest = static_cast<float>(model_.max_depth);
  return rectified_depth<float>(recorded, [=](float metres) {
    return metres >= nearest && metres <= farthest ? metres : 0.0F;  // also for NaN
  });
}

template <class Value, class Metres>
cv::Mat Rectifier::rectified_depth(const cv::Mat& recorded, Metres metres) const {
  cv::Mat depth(camera_->height, camera_->width, CV_32FC1);
  const cv::Mat whole = recorded.isContinuous() ? recorded : recorded.clone();
  for (int y = 0; y < depth.rows; ++y) {
    float* out = depth.ptr<float>(y);
    if (depth_map_.empty()) {
      const Value* in = whole.ptr<Value>(y + crop_.y) + crop_.x;
      for (int x = 0; x < depth.cols; ++x) out[x] = metres(in[x]);
    } else {
      const int* from = &depth_map_[static_cast<std::size_t>(y) * depth.cols];
      const Value* in = whole.ptr<Value>();
      for (int x = 0; x < depth.cols; ++x) out[x] = from[x] < 0 ? 0.0F : metres(in[from[x]]);
    }
  }
  return depth;
}

void Rectifier::check(const cv::Mat& image, const char* name,
                      std::initializer_list<int> types) const {
  if (image.empty())
    throw Error(Fault::kData, std::string("the ") + name + " image is empty", "",
                "look whether its file could be read, or what the driver gave");
  if (image.size() != cv::Size(model_.width, model_.height))
    throw Error(Fault::kData,
                std::string("the ") + name + " image has " + size_text(image.size()) +
                    " pixels, but camera '" + model_.name + "' has " +
                    size_text({model_.width, model_.height}),
                "", "choose the camera of these images");
  if (std::ranges::find(types, image.type()) == types.end())
    throw Error(Fault::kData,
                std::string("the ") + name + " image is of " + cv::typeToString(image.type()), "",
                std::string("it must be of ") + cv::typeToString(*types.begin()));
}

}  // namespace stillpoint
