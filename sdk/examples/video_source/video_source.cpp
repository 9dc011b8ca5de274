#include "video_source.hpp"

#include <algorithm>
#include <fstream>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <stillpoint/support/size_text.hpp>

namespace fs = std::filesystem;
using stillpoint::CameraModel;
using stillpoint::Error;
using stillpoint::Fault;

namespace {

const CameraModel& camera_of(const stillpoint::StageContext& context) {
  if (context.camera) return *context.camera;
  throw Error(Fault::kUsage, "no camera is given", "",
              "put a camera.yaml beside the video, or name one with --camera");
}

fs::path folder_of(const VideoSource::Options& options) {
  if (!options.path.empty()) return options.path;
  throw Error(Fault::kUsage, "no folder is given", "", "name it with --dataset or as 'path'");
}

fs::path existing(const fs::path& path) {
  if (fs::exists(path)) return path;
  throw Error(Fault::kData, "there is no such file or folder", path.string(),
              "the options of the source say what its files are called");
}

std::vector<fs::path> images_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(existing(folder)))
    if (entry.path().extension() == ".png") files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

/// One number per line; lines that begin with # are comments.
std::vector<double> times_in(const fs::path& file) {
  std::ifstream stream(existing(file));
  std::vector<double> times;
  int number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    if (line.empty() || line.front() == '#') continue;
    const std::string where = file.string() + ":" + std::to_string(number);
    double time = 0;
    if (!(std::istringstream(line) >> time))
      throw Error(Fault::kData, "'" + line + "' is no time in seconds", where);
    if (!times.empty() && time <= times.back())
      throw Error(Fault::kData, "this time is not later than the one before", where);
    times.push_back(time);
  }
  return times;
}

/// OpenCV's own complaints are not printed while it exists.
class QuietOpenCv {
 public:
  QuietOpenCv() : before_(cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT)) {}
  ~QuietOpenCv() { cv::utils::logging::setLogLevel(before_); }
  QuietOpenCv(const QuietOpenCv&) = delete;
  QuietOpenCv& operator=(const QuietOpenCv&) = delete;

 private:
  cv::utils::logging::LogLevel before_;
};

cv::VideoCapture opened(const fs::path& file) {
  const QuietOpenCv quiet;
  cv::VideoCapture video(existing(file).string());
  if (video.isOpened()) return video;
  throw Error(Fault::kData, "OpenCV cannot read this as a video", file.string(),
              "convert it to H.264 or MJPEG");
}

void require_size(cv::Size size, const CameraModel& camera, const fs::path& file) {
  const cv::Size expected(camera.width, camera.height);
  if (size == expected) return;
  throw Error(Fault::kData,
              "images have " + stillpoint::size_text(size) + " pixels, but camera '" + camera.name +
                  "' has " + stillpoint::size_text(expected),
              file.string(), "depth must be registered to colour, and the camera be that of both");
}

cv::Mat read_depth(const fs::path& file, const CameraModel& camera) {
  const QuietOpenCv quiet;
  cv::Mat depth = cv::imread(file.string(), cv::IMREAD_UNCHANGED);
  if (depth.type() != CV_16UC1)
    throw Error(Fault::kData, "this is no PNG with one channel of 16 bits", file.string());
  require_size(depth.size(), camera, file);
  return depth;
}

}  // namespace

void VideoSource::Options::visit(stillpoint::OptionVisitor& v) {
  v("path", path, {.help = "folder of the recording", .is_path = true});
  v("video", video, {.help = "in the folder: colour, as any video that OpenCV reads"});
  v("depth", depth, {.help = "in the folder: a folder of 16-bit PNGs, registered to colour"});
  v("times", times, {.help = "in the folder: the time of each frame in seconds, one per line"});
}

VideoSource::VideoSource(const Options& options, const stillpoint::StageContext& context)
    : folder_(folder_of(options)),
      video_file_(folder_ / options.video),
      depth_files_(images_in(folder_ / options.depth)),
      times_(times_in(folder_ / options.times)),
      camera_(camera_of(context)),
      rectifier_(camera_),
      video_(opened(video_file_)) {
  if (times_.empty() || times_.size() != depth_files_.size())
    throw Error(Fault::kData,
                std::to_string(depth_files_.size()) + " depth images, but " +
                    std::to_string(times_.size()) + " times in " + options.times,
                (folder_ / options.depth).string());
  require_size({static_cast<int>(video_.get(cv::CAP_PROP_FRAME_WIDTH)),
                static_cast<int>(video_.get(cv::CAP_PROP_FRAME_HEIGHT))},
               camera_, video_file_);
}

std::optional<stillpoint::Frame> VideoSource::next() {
  cv::Mat bgr;
  const bool read = video_.read(bgr);
  if (next_ == times_.size()) {
    if (!read) return std::nullopt;
    throw Error(
        Fault::kData,
        "the video goes on, but there are only " + std::to_string(times_.size()) + " depth images",
        video_file_.string(), "image i of the video belongs to depth image i");
  }
  if (!read) {
    report_.skipped = times_.size() - next_;
    report_.warnings = {video_file_.string() + ": ended after " + std::to_string(next_) + " of " +
                        std::to_string(times_.size()) + " images"};
    return std::nullopt;
  }
  const cv::Mat depth = read_depth(depth_files_[next_], camera_);
  stillpoint::Frame frame = rectifier_.frame(times_[next_], bgr, depth);
  frame.index = next_++;
  return frame;
}

fs::path VideoSource::ground_truth() const {
  const fs::path file = folder_ / "groundtruth.txt";
  return fs::exists(file) ? file : fs::path();
}

STILLPOINT_PLUGIN(video_source, "0.1.0",
                  stillpoint::provide<stillpoint::Source, VideoSource>(
                      "video", "colour from a video file, depth from a folder of PNGs"));
