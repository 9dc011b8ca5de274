// How far apart the images of a stream are, and how far apart those of a pair may therefore be.
#pragma once

#include <deque>
#include <optional>

namespace stillpoint::live_camera {

/// Of a camera whose images may be lost.
class StreamPeriod {
 public:
  /// The time of the next image in seconds.
  void add(double time);
  /// In seconds, of the shorter ones of the last intervals, since longer ones have gaps. Nothing
  /// before there are two images.
  std::optional<double> seconds() const;

 private:
  std::optional<double> last_;    // s
  std::deque<double> intervals_;  // s
};

/// Of the period of a stream, the largest difference of a pair: an image that is more than half of
/// it away is nearer to another one, which was lost or comes yet. The rest is for stamps that
/// jitter: colour and depth of a Kinect, which are taken independently, are up to half a period
/// apart.
constexpr double kLargestShare = 0.6;

/// `max_difference`, or kLargestShare of the shorter period where that is less. All in seconds.
double pairing_limit(double max_difference, const StreamPeriod& color, const StreamPeriod& depth);

}  // namespace stillpoint::live_camera
