#include "live_camera/live_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace stillpoint::live_camera {
namespace {

constexpr std::size_t kWaitingPairs = 2;
constexpr std::size_t kWaitingImages = 4;  // of a kind, without partner

}  // namespace

void LivePairs::put_color(double seconds, cv::Mat bgr) {
  const std::lock_guard lock(mutex_);
  color_period_.add(seconds);
  if (auto depth = partner(seconds, depths_))
    deliver({seconds, std::move(bgr), std::move(depth->pixels)});
  else
    keep({seconds, std::move(bgr)}, colors_);
}

void LivePairs::put_depth(double seconds, cv::Mat depth) {
  const std::lock_guard lock(mutex_);
  depth_period_.add(seconds);
  if (auto color = partner(seconds, colors_))
    deliver({color->seconds, std::move(color->pixels), std::move(depth)});
  else
    keep({seconds, std::move(depth)}, depths_);
}

std::optional<LivePairs::Image> LivePairs::partner(double seconds, Waiting& others) {
  const auto distance = [&](const Image& image) { return std::abs(image.seconds - seconds); };
  const auto closest = std::ranges::min_element(others, {}, distance);
  const double limit = pairing_limit(max_difference_, color_period_, depth_period_);
  if (closest == others.end() || distance(*closest) > limit) return std::nullopt;
  Image image = std::move(*closest);
  unpaired_ += static_cast<std::size_t>(closest - others.begin());
  others.erase(others.begin(), closest + 1);
  return image;
}

void LivePairs::keep(Image image, Waiting& own) {
  own.push_back(std::move(image));
  if (own.size() <= kWaitingImages) return;
  own.pop_front();
  ++unpaired_;
}

void LivePairs::deliver(LivePair pair) {
  pairs_.push_back(std::move(pair));
  if (pairs_.size() > kWaitingPairs) {
    pairs_.pop_front();
    ++dropped_;
  }
  changed_.notify_one();
}

void LivePairs::end(std::string why) {
  const std::lock_guard lock(mutex_);
  if (why_ended_.empty()) why_ended_ = std::move(why);
  changed_.notify_one();
}

void LivePairs::restart() {
  const std::lock_guard lock(mutex_);
  dropped_ += pairs_.size();
  unpaired_ += colors_.size() + depths_.size();
  pairs_.clear();
  colors_.clear();
  depths_.clear();
  color_period_ = depth_period_ = {};
  why_ended_.clear();
}

std::optional<LivePair> LivePairs::take(std::chrono::milliseconds timeout, std::stop_token stop) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, stop, timeout, [&] { return !pairs_.empty() || !why_ended_.empty(); });
  if (pairs_.empty() || stop.stop_requested()) return std::nullopt;
  LivePair pair = std::move(pairs_.front());
  pairs_.pop_front();
  return pair;
}

std::string LivePairs::why_ended() const {
  const std::lock_guard lock(mutex_);
  return why_ended_;
}

std::size_t LivePairs::dropped() const {
  const std::lock_guard lock(mutex_);
  return dropped_;
}

std::size_t LivePairs::unpaired() const {
  const std::lock_guard lock(mutex_);
  return unpaired_;
}

}  // namespace stillpoint::live_camera
