#include "segmenter_opencv_dnn/class_scores.hpp"

#include <opencv2/core.hpp>

namespace stillpoint::segmenter_opencv_dnn {
namespace {

std::vector<cv::Mat> softmax(const std::vector<cv::Mat>& logits) {
  cv::Mat highest = logits.front().clone();
  for (const cv::Mat& logit : logits) cv::max(highest, logit, highest);
  cv::Mat sum = cv::Mat::zeros(highest.size(), CV_32FC1);
  std::vector<cv::Mat> result(logits.size());
  for (std::size_t i = 0; i < logits.size(); ++i) {
    cv::exp(logits[i] - highest, result[i]);
    sum += result[i];
  }
  for (cv::Mat& probability : result) probability /= sum;
  return result;
}

cv::Mat sigmoid(const cv::Mat& logit) {
  cv::Mat result;
  cv::exp(-logit, result);
  cv::divide(1.0, result + 1.0, result);
  return result;
}

}  // namespace

std::vector<cv::Mat> planes_of(const cv::Mat& output) {
  const int dims = output.dims;
  const bool batch_of_one = dims == 4 && output.size[0] == 1;
  if ((dims != 3 && !batch_of_one) || output.type() != CV_32FC1 || output.empty()) return {};
  const int height = output.size[dims - 2];
  const int width = output.size[dims - 1];
  std::vector<cv::Mat> planes;
  for (int i = 0; i < output.size[dims - 3]; ++i) {
    const float* data = dims == 4 ? output.ptr<float>(0, i) : output.ptr<float>(i);
    planes.emplace_back(height, width, CV_32FC1, const_cast<float*>(data));
  }
  return planes;
}

std::vector<ScorePlane> competing_planes(const std::vector<cv::Mat>& planes,
                                         const ScoreRule& rule) {
  const auto constant = [&](double value) {
    return ScorePlane{cv::Mat(planes.front().size(), CV_32FC1, cv::Scalar(value)), 0};
  };
  switch (rule.result) {
    case ResultKind::kProbability:
      return {constant(rule.threshold), {planes.front(), 1}};
    case ResultKind::kLogit:
      return {constant(rule.margin), {planes.front(), 1}};
    default:
      break;
  }
  std::vector<ScorePlane> result;
  for (std::size_t i = 0; i < planes.size(); ++i)
    result.push_back({planes[i], static_cast<int>(i)});
  if (rule.result == ResultKind::kClassProbabilities)
    result.insert(result.begin(), constant(rule.threshold));
  else
    result.front().scores = planes.front() + rule.margin;
  return result;
}

std::vector<cv::Mat> probabilities(const std::vector<cv::Mat>& planes, ResultKind result) {
  switch (result) {
    case ResultKind::kClassLogits:
      return softmax(planes);
    case ResultKind::kProbability:
      return {cv::Mat(), planes.front()};
    case ResultKind::kLogit:
      return {cv::Mat(), sigmoid(planes.front())};
    default:
      return planes;
  }
}

}  // namespace stillpoint::segmenter_opencv_dnn
