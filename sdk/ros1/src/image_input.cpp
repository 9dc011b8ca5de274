#include "image_input.hpp"

#include <ros/console.h>

#include <utility>

namespace stillpoint_ros {
namespace {

constexpr std::uint32_t kUnpaired = 30;  // images that may wait for the other of their pair

}  // namespace

ImageInput::ImageInput(ros::NodeHandle node, const Parameters& parameters)
    : approximate_stamps_(parameters.approximate),
      max_difference_(parameters.max_difference),
      queue_size_(static_cast<std::size_t>(parameters.queue_size)),
      color_(node, "rgb/image_raw", kUnpaired),
      depth_(node, "depth_registered/image_raw", kUnpaired),
      info_subscriber_(node.subscribe<sensor_msgs::CameraInfo>(
          "rgb/camera_info", 1, [this](const sensor_msgs::CameraInfoConstPtr& info) {
            const std::lock_guard lock(mutex_);
            info_ = info;
            changed_.notify_one();
          })) {
  ROS_INFO("waiting for images on %s, %s and %s", color_.getTopic().c_str(),
           depth_.getTopic().c_str(), info_subscriber_.getTopic().c_str());
  make_pairs();
}

void ImageInput::make_pairs() {
  if (approximate_stamps_) {
    message_filters::sync_policies::ApproximateTime<Image, Image> policy(kUnpaired);
    policy.setMaxIntervalDuration(max_difference_);
    // Not const, it would be taken for a third topic.
    approximate_ = std::make_unique<Approximate>(std::as_const(policy), color_, depth_);
    approximate_->registerCallback(&ImageInput::add, this);
  } else {
    using Policy = message_filters::sync_policies::ExactTime<Image, Image>;
    exact_ = std::make_unique<Exact>(Policy(kUnpaired), color_, depth_);
    exact_->registerCallback(&ImageInput::add, this);
  }
}

std::optional<ImagePair> ImageInput::take() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return stopped_ || (info_ && !pairs_.empty()); });
  if (stopped_) return std::nullopt;
  ImagePair pair = std::move(pairs_.front());
  pair.info = info_;
  pairs_.pop_front();
  last_ = Clock::now();
  return pair;
}

void ImageInput::stop() {
  const std::lock_guard lock(mutex_);
  stopped_ = true;
  changed_.notify_all();
}

// What waits for a partner is within the synchroniser: with ApproximateTime, the last pair of a bag
// waits there, and would be the first one of the next bag.
void ImageInput::forget() {
  make_pairs();
  const std::lock_guard lock(mutex_);
  pairs_.clear();
  last_ = Clock::now();
}

double ImageInput::silence() const {
  const std::lock_guard lock(mutex_);
  if (info_ && !pairs_.empty()) return 0.0;
  return std::chrono::duration<double>(Clock::now() - last_).count();
}

int ImageInput::dropped() const {
  const std::lock_guard lock(mutex_);
  return dropped_;
}

void ImageInput::add(const sensor_msgs::ImageConstPtr& color,
                     const sensor_msgs::ImageConstPtr& depth) {
  const std::lock_guard lock(mutex_);
  if (!info_)
    ROS_WARN_DELAYED_THROTTLE(10, "images come, but no CameraInfo on %s; they are not used",
                              info_subscriber_.getTopic().c_str());
  if (pairs_.size() == queue_size_) {
    pairs_.pop_front();
    ++dropped_;
  }
  pairs_.push_back({color, depth, nullptr});
  last_ = Clock::now();
  changed_.notify_one();
}

}  // namespace stillpoint_ros
