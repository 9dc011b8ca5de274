// Pairs of a colour and a depth image, from three topics, and a queue of them.
#pragma once

#include <message_filters/subscriber.h>
#include <message_filters/sync_policies/approximate_time.h>
#include <message_filters/sync_policies/exact_time.h>
#include <message_filters/synchronizer.h>
#include <ros/node_handle.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include <chrono>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>

#include "parameters.hpp"

namespace stillpoint_ros {

struct ImagePair {
  sensor_msgs::ImageConstPtr color, depth;
  sensor_msgs::CameraInfoConstPtr info;  ///< of the colour image; the last one
};

/// Subscribes `rgb/image_raw`, `depth_registered/image_raw` and `rgb/camera_info`. Pairs wait in a
/// queue; when it is full, the oldest is dropped. Calls from any thread.
class ImageInput {
 public:
  ImageInput(ros::NodeHandle node, const Parameters& parameters);

  /// Waits for the next pair and the first CameraInfo; nothing after stop().
  std::optional<ImagePair> take();
  void stop();
  /// Drops what waits, for tracking or for the other image of its pair: stamps may begin anew. On
  /// the thread of the images only.
  void forget();
  /// Seconds since the last pair came or was taken; 0 while one waits for tracking.
  double silence() const;
  /// Pairs that came and were not taken in time.
  int dropped() const;

 private:
  using Image = sensor_msgs::Image;
  using Exact =
      message_filters::Synchronizer<message_filters::sync_policies::ExactTime<Image, Image>>;
  using Approximate =
      message_filters::Synchronizer<message_filters::sync_policies::ApproximateTime<Image, Image>>;

  using Clock = std::chrono::steady_clock;

  void make_pairs();
  void add(const sensor_msgs::ImageConstPtr& color, const sensor_msgs::ImageConstPtr& depth);

  const bool approximate_stamps_;
  const ros::Duration max_difference_;
  const std::size_t queue_size_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<ImagePair> pairs_;
  bool stopped_ = false;
  int dropped_ = 0;
  Clock::time_point last_ = Clock::now();  // that a pair came or was taken
  sensor_msgs::CameraInfoConstPtr info_;   // the last one

  // Last: their callbacks use the others.
  message_filters::Subscriber<Image> color_, depth_;
  std::unique_ptr<Exact> exact_;
  std::unique_ptr<Approximate> approximate_;
  ros::Subscriber info_subscriber_;
};

}  // namespace stillpoint_ros
