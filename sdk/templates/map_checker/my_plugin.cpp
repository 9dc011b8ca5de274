#include "my_plugin.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace plugins::my_plugin {

void MyPlugin::remember(const stillpoint::TrackedFrame& frame) {
  earlier_.push_back(frame);
  if (static_cast<int>(earlier_.size()) > options_.age) earlier_.pop_front();
}

stillpoint::MapEvidence MyPlugin::check(const stillpoint::Frame& frame,
                                        std::span<const stillpoint::Pose> guesses,
                                        const stillpoint::SparseMap& map) {
  if (earlier_.empty()) return {};  // nothing is known
  const stillpoint::TrackedFrame& earlier = earlier_.front();
  const stillpoint::Camera& camera = *earlier.frame->camera;
  const stillpoint::Pose earlier_from_frame = earlier.pose_in(map).inverse() * guesses.front();
  // The smallest depth around a pixel, and none beside one without: edges, where a small error of
  // the pose changes depth by much, violate no free space.
  cv::Mat seen;
  cv::erode(earlier.frame->depth, seen, cv::Mat::ones(5, 5, CV_8U));

  const int cell = options_.cell;
  const cv::Size cells((frame.depth.cols + cell - 1) / cell, (frame.depth.rows + cell - 1) / cell);
  stillpoint::MapEvidence result{cv::Mat::zeros(cells, CV_32FC1)};
  const auto strength = static_cast<float>(options_.log_odds);
  for (int row = 0; row < cells.height; ++row) {
    for (int column = 0; column < cells.width; ++column) {
      const int u = std::min(column * cell + cell / 2, frame.depth.cols - 1);
      const int v = std::min(row * cell + cell / 2, frame.depth.rows - 1);
      const float depth = frame.depth.at<float>(v, u);
      if (!(depth > 0)) continue;
      const Eigen::Vector3d point = earlier_from_frame * frame.camera->unproject(u, v, depth);
      if (!(point.z() > 0)) continue;
      const Eigen::Vector2d pixel = camera.project(point);
      if (!camera.contains(pixel.x(), pixel.y(), 1)) continue;
      const cv::Point at(cvRound(pixel.x()), cvRound(pixel.y()));
      const double before = seen.at<float>(at);
      if (!(before > 0)) continue;
      if (point.z() < before - options_.tolerance) {
        result.log_odds.at<float>(row, column) = strength;  // where the earlier frame saw through
      } else if (point.z() < before + options_.tolerance) {
        // A person who stays is the same surface, and is not static for that.
        const bool was_static =
            !earlier.weights ||
            stillpoint::StaticWeights::at(earlier.weights->track, static_cast<float>(at.x),
                                          static_cast<float>(at.y)) > 0;
        if (was_static) result.log_odds.at<float>(row, column) = -strength;
      }
    }
  }
  return result;
}

}  // namespace plugins::my_plugin

// What the library provides: the type `my_plugin`.
STILLPOINT_PLUGIN(my_plugin, "0.1.0",
                  stillpoint::provide<stillpoint::MapChecker, plugins::my_plugin::MyPlugin>(
                      "my_plugin", "depth compared with an earlier frame"));
