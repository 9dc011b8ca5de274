// Pairs of colour and depth images of a camera that does not wait.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <stop_token>
#include <string>

#include "live_camera/stream_period.hpp"

namespace stillpoint::live_camera {

struct LivePair {
  double seconds = 0.0;  ///< of the colour image
  cv::Mat bgr;
  cv::Mat depth;  ///< in the units of the driver
};

/// The driver's thread puts images in, the source takes pairs out. Two pairs may wait; when a third
/// comes, the oldest is dropped and counted: tracking sees the newest images, however slow it is.
/// Thread-safe.
class LivePairs {
 public:
  /// Images of a pair are at most `max_difference` seconds apart, and less where they come faster:
  /// an image whose partner was lost does not take that of the next one.
  explicit LivePairs(double max_difference) : max_difference_(max_difference) {}

  /// A new image and its time in seconds. Its pixels must not change any more.
  void put_color(double seconds, cv::Mat bgr);
  void put_depth(double seconds, cv::Mat depth);
  /// The driver ends, for this reason: waiting pairs are still given, then `why` is known.
  void end(std::string why);

  /// The driver begins anew: what waits, and why it had ended, is forgotten. Counts go on.
  void restart();

  /// The oldest waiting pair; nothing when none has come within `timeout`, after end(), or when a
  /// stop is requested.
  std::optional<LivePair> take(std::chrono::milliseconds timeout, std::stop_token stop = {});

  std::string why_ended() const;  ///< empty while the driver works
  std::size_t dropped() const;    ///< pairs that nobody took in time
  std::size_t unpaired() const;   ///< images without one of the other kind at the same time

 private:
  struct Image {
    double seconds;
    cv::Mat pixels;
  };
  using Waiting = std::deque<Image>;

  /// The image of the other kind that is closest in time, if one is close enough. Removes it, and
  /// what is older: it has missed its partner.
  std::optional<Image> partner(double seconds, Waiting& others);
  void keep(Image image, Waiting& own);
  void deliver(LivePair pair);

  const double max_difference_;
  mutable std::mutex mutex_;
  std::condition_variable_any changed_;  // knows stop tokens
  Waiting colors_, depths_;              // without partner yet
  StreamPeriod color_period_, depth_period_;
  std::deque<LivePair> pairs_;
  std::string why_ended_;
  std::size_t dropped_ = 0;
  std::size_t unpaired_ = 0;
};

}  // namespace stillpoint::live_camera
