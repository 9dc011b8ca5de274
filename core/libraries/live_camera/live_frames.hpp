// Frames of a camera that does not wait: what its sources have in common.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>

#include "live_camera/live_driver.hpp"
#include "live_camera/live_pairs.hpp"
#include "live_camera/sensor_clock.hpp"
#include "stillpoint/sdk.hpp"
#include "stillpoint/support/rectifier.hpp"

namespace stillpoint::live_camera {

struct LiveOptions {
  double max_difference = 0.02;  ///< s between the images of a pair
  double timeout = 5.0;          ///< s without images after which the camera counts as gone
  double reconnect_for = 30.0;   ///< s in which a camera that is gone is looked for again
  int limit = 0;                 ///< frames after which the source ends; 0: none

  void visit(OptionVisitor& visitor);
};

/// The `camera:` section with depth in millimetres, as drivers give it; without one, an ideal
/// camera of this size and horizontal field of view in radians, and a warning that it is no
/// calibration. Throws Error(kUsage) for a calibration of another size, and without both
/// (`field_of_view` 0).
CameraModel live_model(const StageContext& context, const std::string& device, int width,
                       int height, double field_of_view);

/// Pairs from the driver's thread become frames of the pipeline's. A camera that was unplugged, or
/// sends nothing for `timeout`, is closed and opened again until it sends or `reconnect_for` is
/// over; the log says that it is gone, and that it is back. Times go on from the computer's clock.
class LiveFrames {
 public:
  /// `device` names the camera in messages; its counter has this rate and number of bits. `log` is
  /// that of the source's StageContext.
  LiveFrames(const LiveOptions& options, const CameraModel& model, std::string device,
             double ticks_per_second, int counter_bits,
             std::function<void(LogLevel, std::string_view)> log = StageContext().log);

  /// As Source::begin().
  void begin(std::stop_token stop) { stop_ = std::move(stop); }

  /// On the driver's thread: an image has arrived, with the device's counter at its exposure.
  /// Images as Rectifier::frame takes them; their pixels must not change any more.
  void put_color(std::uint64_t ticks, cv::Mat bgr);
  void put_depth(std::uint64_t ticks, cv::Mat depth);
  /// On any thread: the camera sends no more, for this reason.
  void end(std::string why) { pairs_.end(std::move(why)); }

  /// The next frame; nothing after `limit` frames or a stop. Waits for it. The first call starts
  /// the driver, always the same one. Throws Error(kData) when the camera sends nothing any more,
  /// and at once when it has not sent anything yet.
  std::optional<Frame> next(LiveDriver& driver);

  /// Pairs that were dropped or late, and images without partner. On the thread of next().
  std::size_t left_out() const;
  /// Of these, of the camera's absences, and of jumps of the device's clock; the log gets it, too.
  SourceReport report() const;

 private:
  std::optional<LivePair> next_pair(LiveDriver& driver);
  /// The first pair of a camera that has come back until then.
  std::optional<LivePair> reconnected(LiveDriver& driver,
                                      std::chrono::steady_clock::time_point deadline);
  bool restarted(LiveDriver& driver);

  LiveOptions options_;
  Rectifier rectifier_;
  std::string device_;
  SensorClock clock_;
  LivePairs pairs_;
  std::stop_token stop_;
  bool started_ = false;
  std::uint32_t given_ = 0;    // frames
  double last_seconds_ = 0.0;  // of the last frame
  std::size_t late_ = 0;       // pairs that were older than the frame before
  int absences_ = 0;           // after which the camera came back
  double seconds_away_ = 0.0;  // in all of them
  std::function<void(LogLevel, std::string_view)> log_;
};

}  // namespace stillpoint::live_camera
