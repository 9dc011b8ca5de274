#include "source_video/video_file_source.hpp"

#include <algorithm>

#include "source_video/late_capture.hpp"
#include "stillpoint/support/size_text.hpp"

namespace stillpoint::source_video {
namespace {

namespace fs = std::filesystem;

fs::path folder_of(const std::string& path) {
  if (!path.empty()) return path;
  throw Error(Fault::kUsage, "no recording is given", "",
              "name its folder with --dataset or as 'path'");
}

const CameraModel& camera_of(const StageContext& context) {
  if (context.camera) return *context.camera;
  throw Error(Fault::kUsage, "no camera is given", "",
              "put a camera.yaml beside the video, or name one with --camera");
}

FrameTimes times_of(const VideoFileSource::Options& options, const fs::path& folder,
                    const cv::VideoCapture& video) {
  if (!options.times.empty()) return FrameTimes(folder / options.times);
  const double rate = options.rate > 0 ? options.rate : video.get(cv::CAP_PROP_FPS);
  if (rate > 0) return {options.first_time, rate};
  throw Error(Fault::kData, "the video does not say how many images per second it has",
              (folder / options.video).string(), "set 'rate', or name a list as 'times'");
}

}  // namespace

void VideoFileSource::Options::visit(OptionVisitor& v) {
  v("path", path, {.help = "folder of the recording", .is_path = true});
  v("video", video, {.help = "in the folder: colour, as any video that OpenCV reads"});
  v("depth", depth, {.help = "in the folder: a folder of 16-bit PNGs, registered to colour"});
  v("times", times,
    {.help = "in the folder: a list with the time of each image in seconds; empty: at a constant "
             "rate"});
  v("rate", rate,
    {.min = 0, .max = 1000, .unit = "Hz", .help = "images per second; 0: what the video says"});
  v("first_time", first_time,
    {.unit = "s", .help = "time of the first image, where there is no list of times"});
  v.choice("pair_by", pair_by, {{"index", PairBy::kIndex}, {"time", PairBy::kTime}},
           {.help = "image i belongs to the i-th depth image in the order of the names, or to the "
                    "one whose name is its time in seconds"});
  v("max_difference", max_difference,
    {.min = 0, .max = 10, .unit = "s", .help = "largest time difference of a pair, by time"});
  v("limit", limit, {.min = 0, .unit = "frames", .help = "most frames to read; 0 for no limit"});
}

VideoFileSource::VideoFileSource(const Options& options, const StageContext& context)
    : options_(options),
      folder_(folder_of(options.path)),
      video_file_(folder_ / options.video),
      depths_(folder_ / options.depth, options.pair_by),
      camera_(camera_of(context)),
      rectifier_(camera_),
      video_(open_video(video_file_)),
      times_(times_of(options, folder_, *video_)),
      skipped_(depths_.size(), folder_.string(), context.log) {
  check_sizes();
}

// What does not fit at the beginning will not fit later.
void VideoFileSource::check_sizes() {
  const cv::Size size(camera_.width, camera_.height);
  const cv::Size of_video(static_cast<int>(video_->get(cv::CAP_PROP_FRAME_WIDTH)),
                          static_cast<int>(video_->get(cv::CAP_PROP_FRAME_HEIGHT)));
  if (of_video != size)
    throw Error(Fault::kData,
                "the images have " + size_text(of_video) + " pixels, but camera '" + camera_.name +
                    "' has " + size_text(size),
                video_file_.string(), "choose the camera of this recording with --camera");
  depths_.read(0, size);
  const auto times = times_.size();
  if (options_.pair_by == PairBy::kIndex && times && *times != depths_.size())
    throw Error(Fault::kData,
                std::to_string(depths_.size()) + " depth images, but " + std::to_string(*times) +
                    " times in " + options_.times,
                depths_.path().string(),
                "image i, depth image i and time i are one frame; with names that are times, set "
                "pair_by: time");
}

std::optional<Frame> VideoFileSource::next() {
  if (options_.limit > 0 && given_ == static_cast<std::uint32_t>(options_.limit))
    return std::nullopt;
  while (auto pair = next_pair()) {
    const auto load = [&] {
      const cv::Mat depth = depths_.read(pair->depth, {camera_.width, camera_.height});
      return rectifier_.frame(pair->time, pair->bgr, depth);
    };
    if (auto frame = skipped_.load_or_skip(load, given_)) {
      ++given_;
      return frame;
    }
  }
  return std::nullopt;
}

std::optional<VideoFileSource::Pair> VideoFileSource::next_pair() {
  for (;;) {
    Pair pair;  // with an image of its own
    if (!video_->read(pair.bgr)) break;
    const std::size_t image = read_++;
    const auto time = times_.at(image);
    if (!time)
      throw Error(Fault::kData,
                  "the video goes on, but there are only " + std::to_string(image) + " times",
                  video_file_.string(), "time i is that of image i");
    const auto depth = depth_of(image, *time);
    if (depth) {
      pair.time = *time;
      pair.depth = *depth;
      return pair;
    }
    ++without_depth_;
  }
  end();
  return std::nullopt;
}

std::optional<std::size_t> VideoFileSource::depth_of(std::size_t image, double time) {
  if (options_.pair_by == PairBy::kTime)
    return depths_.near(time, times_.at(image + 1), options_.max_difference);
  if (image < depths_.size()) return image;
  throw Error(
      Fault::kData,
      "the video goes on, but there are only " + std::to_string(depths_.size()) + " depth images",
      video_file_.string(), "image i of the video belongs to depth image i");
}

void VideoFileSource::end() {
  if (given_ == 0 && without_depth_ > 0)
    throw Error(Fault::kData,
                "no image of the video has a depth image within " +
                    std::to_string(options_.max_difference) + " s",
                depths_.path().string(), "see whether both have times of one clock");
  const auto count = expected();
  if (count && read_ < *count)
    skipped_.warn(video_file_.string() + ": ended after " + std::to_string(read_) + " of " +
                  std::to_string(*count) + " images");
}

std::optional<std::size_t> VideoFileSource::expected() const {
  return options_.pair_by == PairBy::kIndex ? std::optional(depths_.size()) : times_.size();
}

std::optional<std::size_t> VideoFileSource::size() const {
  const auto count = expected();
  if (options_.limit == 0) return count;
  const auto limit = static_cast<std::size_t>(options_.limit);
  return std::min(limit, count.value_or(limit));
}

SourceReport VideoFileSource::report() const {
  SourceReport report = skipped_.report();
  report.skipped += without_depth_;
  if (without_depth_ > 0)
    report.warnings.push_back(std::to_string(without_depth_) +
                              " images of the video have no depth image of their time");
  return report;
}

fs::path VideoFileSource::ground_truth() const {
  const fs::path file = folder_ / "groundtruth.txt";
  return fs::exists(file) ? file : fs::path();
}

}  // namespace stillpoint::source_video
