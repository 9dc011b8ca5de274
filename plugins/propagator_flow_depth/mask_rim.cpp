#include "propagator_flow_depth/mask_rim.hpp"

#include <opencv2/imgproc.hpp>

namespace stillpoint::propagator_flow_depth {

cv::Mat remove_rims(const cv::Mat& mask, int rim) {
  const cv::Size wider(2 * rim + 1, 2 * rim + 1);
  cv::Mat opened;
  cv::morphologyEx(mask, opened, cv::MORPH_OPEN, cv::getStructuringElement(cv::MORPH_RECT, wider));
  return opened;
}

}  // namespace stillpoint::propagator_flow_depth
