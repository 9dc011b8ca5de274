// Source `video`: colour from a video file, depth from a folder of PNGs, times from a list.
#pragma once

#include <filesystem>
#include <opencv2/videoio.hpp>
#include <optional>
#include <stillpoint/sdk.hpp>
#include <stillpoint/support/rectifier.hpp>
#include <string>
#include <vector>

/// Image i of the video, depth image i in the order of the files' names and time i of the list are
/// one frame.
class VideoSource final : public stillpoint::Source {
 public:
  struct Options {
    std::string path;
    std::string video = "video.avi";
    std::string depth = "depth";
    std::string times = "times.txt";

    void visit(stillpoint::OptionVisitor& v);
  };

  /// Throws Error when files are missing or do not belong together.
  VideoSource(const Options& options, const stillpoint::StageContext& context);

  std::optional<stillpoint::Frame> next() override;
  std::optional<std::size_t> size() const override { return times_.size(); }
  stillpoint::SourceReport report() const override { return report_; }
  std::filesystem::path ground_truth() const override;

 private:
  std::filesystem::path folder_;
  std::filesystem::path video_file_;
  std::vector<std::filesystem::path> depth_files_;
  std::vector<double> times_;  // s
  stillpoint::CameraModel camera_;
  stillpoint::Rectifier rectifier_;
  cv::VideoCapture video_;
  std::uint32_t next_ = 0;
  stillpoint::SourceReport report_;
};
