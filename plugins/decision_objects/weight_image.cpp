#include "decision_objects/weight_image.hpp"

#include <opencv2/imgproc.hpp>

namespace stillpoint::decision_objects {

ObjectMask mask_of(const Segmentation& segmentation, std::size_t index, int margin,
                   const cv::Mat& except) {
  const cv::Mat& instances = segmentation.instances;
  const cv::Rect image({0, 0}, instances.size());
  const cv::Rect& box = segmentation.objects[index].box;
  const cv::Rect grown =
      cv::Rect(box.x - margin, box.y - margin, box.width + 2 * margin, box.height + 2 * margin) &
      image;
  if (grown.empty()) return {};
  ObjectMask object{grown, instances(grown) == static_cast<int>(index) + 1};
  if (!except.empty()) object.mask.setTo(0, except(grown));
  if (margin == 0) return object;
  const int side = 2 * margin + 1;
  cv::dilate(object.mask, object.mask, cv::Mat::ones(side, side, CV_8U));
  return object;
}

void lower(cv::Mat& weights, cv::Size size, const ObjectMask& object, std::uint8_t weight) {
  if (object.box.empty()) return;
  if (weights.empty()) weights = cv::Mat(size, CV_8UC1, cv::Scalar(255));
  cv::Mat part = weights(object.box);
  cv::Mat lowered;
  cv::min(part, cv::Scalar(weight), lowered);
  lowered.copyTo(part, object.mask);
}

}  // namespace stillpoint::decision_objects
