#include "segmenter_segnet/class_picking.hpp"

#include <cmath>
#include <opencv2/core.hpp>

namespace stillpoint::segmenter_segnet {
namespace {

/// Scores of the classes at one pixel are `stride` numbers apart.
float softmax_probability(const float* scores, int classes, std::size_t stride, float highest) {
  float sum = 0;
  for (int c = 0; c < classes; ++c)
    sum += std::exp(scores[static_cast<std::size_t>(c) * stride] - highest);
  return 1.0f / sum;
}

}  // namespace

PickedClasses pick_classes(const cv::Mat& scores) {
  const int classes = scores.size[1];
  const cv::Size size(scores.size[3], scores.size[2]);
  const cv::Mat first(size, CV_32F, const_cast<float*>(scores.ptr<float>(0, 0)));
  PickedClasses picked{.labels = cv::Mat(size, CV_8U, cv::Scalar(0)),
                       .probability = cv::Mat(size, CV_32F, cv::Scalar(1))};
  cv::Mat highest = first.clone();
  for (int c = 1; c < classes; ++c) {
    const cv::Mat channel(size, CV_32F, const_cast<float*>(scores.ptr<float>(0, c)));
    picked.labels.setTo(c, channel > highest);
    cv::max(channel, highest, highest);
  }
  const auto pixels = static_cast<std::size_t>(size.area());
  for (std::size_t i = 0; i < pixels; ++i) {
    if (picked.labels.data[i] == 0) continue;
    picked.probability.ptr<float>()[i] =
        softmax_probability(first.ptr<float>() + i, classes, pixels, highest.ptr<float>()[i]);
  }
  return picked;
}

void score_objects(Segmentation& segmentation, const cv::Mat& probability) {
  for (std::size_t i = 0; i < segmentation.objects.size(); ++i) {
    SegmentedObject& object = segmentation.objects[i];
    const cv::Mat mask = segmentation.instances(object.box) == static_cast<int>(i) + 1;
    object.score = static_cast<float>(cv::mean(probability(object.box), mask)[0]);
  }
}

}  // namespace stillpoint::segmenter_segnet
