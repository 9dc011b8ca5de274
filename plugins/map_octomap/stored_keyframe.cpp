#include "map_octomap/stored_keyframe.hpp"

#include <zstd.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace stillpoint::map_octomap {
namespace {

constexpr float kDepthSteps = 5000;  // per metre, as in TUM's recordings
constexpr int kCompression = 1;      // the fastest

// Planes of one byte per pixel, one after the other.
enum Plane { kDepthLow, kDepthHigh, kBlue, kGreen, kRed, kLabel, kWeight, kPlanes };

std::shared_ptr<const Camera> reduced(const Camera& camera, int stride) {
  auto result = std::make_shared<Camera>(camera);
  result->width = camera.width / stride;
  result->height = camera.height / stride;
  result->fx /= stride;
  result->fy /= stride;
  const int middle = stride / 2;
  result->cx = (camera.cx - middle) / stride;
  result->cy = (camera.cy - middle) / stride;
  return result;
}

}  // namespace

StoredKeyFrame::StoredKeyFrame(const DenseKeyFrame& keyframe, int stride)
    : id_(keyframe.id),
      frame_(keyframe.frame->index),
      time_(keyframe.frame->time),
      labelled_(!keyframe.labels().empty()),
      camera_(reduced(*keyframe.frame->camera, stride)) {
  const Frame& frame = *keyframe.frame;
  const cv::Mat labels = keyframe.labels(), weights = keyframe.map_weights();
  const std::size_t count = static_cast<std::size_t>(camera_->width) * camera_->height;
  std::string planes(kPlanes * count, '\0');
  const auto put = [&](Plane plane, std::size_t pixel, int value) {
    planes[plane * count + pixel] = static_cast<char>(value);
  };
  std::size_t pixel = 0;
  for (int y = 0; y < camera_->height; ++y) {
    int before = 0;  // delta coding along the row, which compresses better
    for (int x = 0; x < camera_->width; ++x, ++pixel) {
      const int u = x * stride + stride / 2, v = y * stride + stride / 2;
      const float metres = frame.depth.at<float>(v, u);
      const int depth =
          metres > 0 ? static_cast<int>(std::min(std::lround(metres * kDepthSteps), 65535L)) : 0;
      const int difference = depth - std::exchange(before, depth);
      put(kDepthLow, pixel, difference & 0xFF);
      put(kDepthHigh, pixel, difference >> 8 & 0xFF);
      const auto& bgr = frame.bgr.at<cv::Vec3b>(v, u);
      put(kBlue, pixel, bgr[0]);
      put(kGreen, pixel, bgr[1]);
      put(kRed, pixel, bgr[2]);
      put(kLabel, pixel, labels.empty() ? 0 : labels.at<std::uint8_t>(v, u));
      put(kWeight, pixel, weights.empty() ? 255 : weights.at<std::uint8_t>(v, u));
    }
  }
  packed_.resize(ZSTD_compressBound(planes.size()));
  packed_.resize(
      ZSTD_compress(packed_.data(), packed_.size(), planes.data(), planes.size(), kCompression));
  packed_.shrink_to_fit();
}

DenseKeyFrame StoredKeyFrame::unpack(const Pose& world_from_camera) const {
  const std::size_t count = static_cast<std::size_t>(camera_->width) * camera_->height;
  std::string planes(kPlanes * count, '\0');
  if (ZSTD_decompress(planes.data(), planes.size(), packed_.data(), packed_.size()) !=
      planes.size())
    throw std::logic_error("a stored key frame cannot be unpacked");
  const auto get = [&](Plane plane, std::size_t pixel) {
    return static_cast<std::uint8_t>(planes[plane * count + pixel]);
  };
  const cv::Size size(camera_->width, camera_->height);
  auto frame = std::make_shared<Frame>();
  frame->index = frame_;
  frame->time = time_;
  frame->camera = camera_;
  frame->depth.create(size, CV_32FC1);
  frame->bgr.create(size, CV_8UC3);
  auto segmentation = std::make_shared<Segmentation>();
  segmentation->frame = frame_;
  segmentation->labels.create(size, CV_8UC1);
  auto weights = std::make_shared<StaticWeights>();
  weights->map.create(size, CV_8UC1);
  std::size_t pixel = 0;
  for (int y = 0; y < size.height; ++y) {
    auto* depth = frame->depth.ptr<float>(y);
    auto* bgr = frame->bgr.ptr<cv::Vec3b>(y);
    auto* label = segmentation->labels.ptr<std::uint8_t>(y);
    auto* weight = weights->map.ptr<std::uint8_t>(y);
    std::uint16_t steps = 0;
    for (int x = 0; x < size.width; ++x, ++pixel) {
      steps =
          static_cast<std::uint16_t>(steps + get(kDepthLow, pixel) + 256 * get(kDepthHigh, pixel));
      depth[x] = static_cast<float>(steps) / kDepthSteps;
      bgr[x] = {get(kBlue, pixel), get(kGreen, pixel), get(kRed, pixel)};
      label[x] = get(kLabel, pixel);
      weight[x] = get(kWeight, pixel);
    }
  }
  return {.id = id_,
          .frame = std::move(frame),
          .segmentation = labelled_ ? std::move(segmentation) : nullptr,
          .weights = std::move(weights),
          .world_from_camera = world_from_camera};
}

}  // namespace stillpoint::map_octomap
