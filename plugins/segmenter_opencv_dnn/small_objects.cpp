#include "segmenter_opencv_dnn/small_objects.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace stillpoint::segmenter_opencv_dnn {
namespace {

constexpr double kMinMeasuredShare = 0.25;  // of an object's pixels; else its area is not known

bool is_small(const Segmentation& segmentation, std::size_t object, const Frame& frame,
              const SmallestObject& smallest) {
  if (segmentation.objects[object].pixels < std::max(1, smallest.pixels)) return true;
  if (smallest.area <= 0) return false;
  const std::optional<double> area = visible_area(segmentation, object, frame);
  return area && segmentation.objects[object].score * *area < smallest.area;
}

}  // namespace

std::optional<double> visible_area(const Segmentation& segmentation, std::size_t object,
                                   const Frame& frame) {
  const cv::Rect box = segmentation.objects[object].box;
  const int pixels = segmentation.objects[object].pixels;
  if (frame.depth.empty() || !frame.camera) return std::nullopt;
  int measured = 0;
  double squares = 0;
  for (int v = box.y; v < box.br().y; ++v) {
    const auto* instance = segmentation.instances.ptr<std::uint8_t>(v);
    const auto* z = frame.depth.ptr<float>(v);
    for (int u = box.x; u < box.br().x; ++u) {
      if (instance[u] != object + 1 || z[u] <= 0) continue;
      ++measured;
      squares += static_cast<double>(z[u]) * z[u];
    }
  }
  if (measured == 0 || measured < kMinMeasuredShare * pixels) return std::nullopt;
  return pixels * (squares / measured) / (frame.camera->fx * frame.camera->fy);
}

void remove_small_objects(Segmentation& segmentation, const Frame& frame,
                          const SmallestObject& smallest) {
  std::vector<SegmentedObject> kept;
  for (std::size_t i = 0; i < segmentation.objects.size(); ++i) {
    const SegmentedObject& object = segmentation.objects[i];
    const bool small = is_small(segmentation, i, frame, smallest);
    const cv::Mat mask = segmentation.instances(object.box) == static_cast<double>(i + 1);
    segmentation.instances(object.box)
        .setTo(small ? 0 : static_cast<double>(kept.size() + 1), mask);
    if (small) segmentation.labels(object.box).setTo(0, mask);
    if (!small) kept.push_back(object);
  }
  segmentation.objects = std::move(kept);
}

}  // namespace stillpoint::segmenter_opencv_dnn
