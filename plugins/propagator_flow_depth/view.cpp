#include "propagator_flow_depth/view.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "propagator_flow_depth/point_follower.hpp"

namespace stillpoint::propagator_flow_depth {

View make_view(const Frame& frame, View recycled) {
  View view = std::move(recycled);
  view.frame = frame.index;
  view.time = frame.time;
  view.ids.clear();
  view.instances.release();
  const cv::Size size(std::max(1, frame.gray.cols / kViewScale),
                      std::max(1, frame.gray.rows / kViewScale));
  cv::Mat gray;
  cv::resize(frame.gray, gray, size, 0, 0, cv::INTER_AREA);
  build_flow_pyramid(gray, view.pyramid);
  view.depth.create(size, CV_32FC1);
  if (frame.depth.empty())
    view.depth.setTo(0);
  else
    cv::resize(frame.depth, view.depth, size, 0, 0, cv::INTER_NEAREST);
  return view;
}

float depth_at(const View& view, cv::Point2f position) {
  const int x = std::clamp(cvRound(position.x), 0, view.depth.cols - 1);
  const int y = std::clamp(cvRound(position.y), 0, view.depth.rows - 1);
  return view.depth.at<float>(y, x);
}

}  // namespace stillpoint::propagator_flow_depth
