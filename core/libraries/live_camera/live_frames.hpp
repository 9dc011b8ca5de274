// Frames of a camera that does not wait: what its sources have in common.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "live_camera/live_pairs.hpp"
#include "live_camera/sensor_clock.hpp"
#include "stillpoint/sdk.hpp"
#include "stillpoint/support/rectifier.hpp"

namespace stillpoint::live_camera {

struct LiveOptions {
  double max_difference = 0.02;  ///< s between the images of a pair
  double timeout = 5.0;          ///< s without images after which the camera counts as gone
  int limit = 0;                 ///< frames after which the source ends; 0: none

  void visit(OptionVisitor& visitor);
};

/// The `camera:` section with depth in millimetres, as drivers give it; without one, an ideal
/// camera of this size and horizontal field of view in radians, and a warning that it is no
/// calibration. Throws Error(kUsage) for a calibration of another size, and without both
/// (`field_of_view` 0).
CameraModel live_model(const StageContext& context, const std::string& device, int width,
                       int height, double field_of_view);

/// Pairs from the driver's thread become frames of the pipeline's.
class LiveFrames {
 public:
  /// `device` names the camera in messages; its counter has this rate and number of bits. `log` is
  /// that of the source's StageContext.
  LiveFrames(const LiveOptions& options, const CameraModel& model, std::string device,
             double ticks_per_second, int counter_bits,
             std::function<void(LogLevel, std::string_view)> log = StageContext().log);

  /// On the driver's thread: an image has arrived, with the device's counter at its exposure.
  /// Images as Rectifier::frame takes them; their pixels must not change any more.
  void put_color(std::uint64_t ticks, cv::Mat bgr);
  void put_depth(std::uint64_t ticks, cv::Mat depth);
  /// On any thread: the camera sends no more, for this reason.
  void end(std::string why) { pairs_.end(std::move(why)); }

  /// The next frame; nothing after `limit` frames. Waits for it. Throws Error(kData) when the
  /// camera sends nothing any more.
  std::optional<Frame> next();

  /// Dropped pairs, images without partner, and jumps of the device's clock; the log gets them,
  /// too.
  SourceReport report() const;

 private:
  LiveOptions options_;
  Rectifier rectifier_;
  std::string device_;
  SensorClock clock_;
  LivePairs pairs_;
  std::uint32_t given_ = 0;    // frames
  double last_seconds_ = 0.0;  // of the last frame
  std::size_t late_ = 0;       // pairs that were older than the frame before
  std::function<void(LogLevel, std::string_view)> log_;
};

}  // namespace stillpoint::live_camera
