// Frames of images that somebody publishes.
#pragma once

#include <functional>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>

#include "live_camera/stream_period.hpp"
#include "ros2/missing_frames.hpp"
#include "ros2/participant.hpp"
#include "stillpoint/sdk.hpp"
#include "stillpoint/support/rectifier.hpp"

namespace stillpoint::ros2 {

/// Listens from its construction on. next() waits for CameraInfo, where the pipeline names no
/// camera, and for a pair of images; it throws Error(kData) when none comes, for images that cannot
/// be read, and for depth that is not registered to colour. Silence after the first pair is the
/// end. Where stamps go back by more than a second, because a clock was set back or a bag is played
/// again, times go on by one interval: those of all later frames differ from their stamps.
class Ros2Source final : public Source {
 public:
  struct Options {
    std::string color_topic = "rgb/image_raw";
    std::string depth_topic = "depth_registered/image_raw";
    std::string info_topic = "rgb/camera_info";
    int domain = -1;               ///< negative: that of ROS_DOMAIN_ID, or 0
    bool reliable = false;         ///< lost packets are sent again
    int queue_size = 5;            ///< images that wait, of each topic
    bool approximate = false;      ///< stamps of a pair may differ, by max_difference
    double max_difference = 0.02;  ///< seconds
    bool rectified = false;        ///< P of CameraInfo holds, not K and D
    bool registered = false;       ///< depth is, whatever its frame says
    double depth_factor = 0.0;     ///< of 16-bit depth, value of one metre; 0: the camera's
    double timeout = 5.0;          ///< seconds
    int limit = 0;                 ///< frames; 0: none

    void visit(OptionVisitor& visitor);
  };

  Ros2Source(const Options& options, const StageContext& context);

  void begin(std::stop_token stop) override { stop_ = std::move(stop); }
  std::optional<Frame> next() override;
  std::size_t left_out() const override { return left_out_; }
  SourceReport report() const override;

 private:
  struct Image {
    double stamp = 0.0;  ///< seconds, of the header
    std::string frame;   ///< of the header
    cv::Mat pixels;
  };
  enum class Kind { kColor, kDepth };

  /// An estimate of the frames that never came.
  std::size_t count_missing() const;
  /// With images without a partner, and pairs that came late.
  std::size_t count_left_out() const;
  /// Only a stop ends the wait without one.
  void wait_for_camera();
  /// The next image of a topic becomes `image`, unless there is one. False when none comes in time.
  bool wait_for(std::optional<Image>& image, const Reader& reader, Kind kind);
  /// Whether the waiting images belong together; otherwise one of them is dropped, or both.
  bool is_pair();
  /// Throws Error(kData) when depth is not seen from the colour camera; tells of another unit than
  /// that of ROS.
  void check_first_pair(const Image& color, const Image& depth) const;
  /// The waiting images, if they belong together and come after the frame before.
  std::optional<Frame> frame_of_waiting();
  /// Whether a stamp is of a clock that was set back since the last frame.
  bool goes_back(double stamp) const;
  /// Times go on behind the last frame with this stamp.
  void go_on_from(double stamp);
  [[noreturn]] void fail(const Reader& missing) const;

  Options options_;
  std::optional<CameraModel> camera_file_;
  std::function<void(LogLevel, std::string_view)> log_;
  Participant participant_;
  Reader color_reader_, depth_reader_;
  std::optional<Reader> info_reader_;
  std::optional<Rectifier> rectifier_;
  std::stop_token stop_;
  std::optional<Image> color_, depth_;  // waiting for each other
  live_camera::StreamPeriod color_period_, depth_period_;
  bool ended_ = false;
  std::uint32_t given_ = 0;   // frames
  double last_time_ = 0.0;    // of the last frame, seconds
  double shift_ = 0.0;        // from stamps to times, seconds
  std::size_t returns_ = 0;   // of the stamps, to a time that has been
  std::size_t unpaired_ = 0;  // images
  std::size_t unpaired_depth_ = 0;
  std::size_t backwards_ = 0;  // pairs that are not later than the one before
  MissingFrames missing_;      // by the times of colour images
  std::size_t left_out_ = 0;   // images, as counted last
};

}  // namespace stillpoint::ros2
