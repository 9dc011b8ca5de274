// Frames of a video file with depth images beside it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <opencv2/videoio.hpp>
#include <optional>
#include <string>

#include "source_video/depth_folder.hpp"
#include "source_video/frame_times.hpp"
#include "stillpoint/sdk.hpp"
#include "stillpoint/support/rectifier.hpp"
#include "tum_recording/skipped_pairs.hpp"

namespace stillpoint::source_video {

/// Images without a depth image of the same time, and damaged depth images, are left out and
/// counted. Throws Error(kData) when files do not belong together.
class VideoFileSource final : public Source {
 public:
  struct Options {
    std::string path;                 ///< folder of the recording
    std::string video = "video.avi";  ///< in it
    std::string depth = "depth";      ///< in it: the folder of depth images
    std::string times;                ///< in it; empty: at `rate`
    double rate = 0.0;                ///< Hz; 0: what the video says
    double first_time = 0.0;          ///< s, without a list of times
    PairBy pair_by = PairBy::kIndex;
    double max_difference = 0.02;  ///< s, of a pair by time
    int limit = 0;                 ///< frames; 0: none

    void visit(OptionVisitor& visitor);
  };

  VideoFileSource(const Options& options, const StageContext& context);

  std::optional<Frame> next() override;
  std::optional<std::size_t> size() const override;
  SourceReport report() const override;
  std::filesystem::path ground_truth() const override;

 private:
  struct Pair {
    double time = 0.0;  // s
    cv::Mat bgr;
    std::size_t depth = 0;  // its number in the folder
  };

  void check_sizes();
  /// Of the images of the video, as far as lists and folder say.
  std::optional<std::size_t> expected() const;
  /// The next image of the video that has a depth image.
  std::optional<Pair> next_pair();
  std::optional<std::size_t> depth_of(std::size_t image, double time);
  void end();

  const Options options_;
  const std::filesystem::path folder_, video_file_;
  DepthFolder depths_;
  const CameraModel camera_;
  const Rectifier rectifier_;
  std::unique_ptr<cv::VideoCapture> video_;
  FrameTimes times_;
  tum_recording::SkippedPairs skipped_;
  std::size_t read_ = 0;           // images of the video
  std::size_t without_depth_ = 0;  // of them, by time
  std::uint32_t given_ = 0;        // frames
};

}  // namespace stillpoint::source_video
