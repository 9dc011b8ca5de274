#include "ros2/ros2_source.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "bag/bag_reader.hpp"
#include "bag/camera_model.hpp"
#include "bag/raw_image.hpp"
#include "bag/registration.hpp"

namespace stillpoint::ros2 {
namespace {

using std::chrono::steady_clock;

constexpr double kStepBack = 1.0;  // seconds; images that come out of order are nearer
// How many are missing is estimated from all intervals so far.
constexpr std::uint32_t kFramesPerCount = 30;

template <class... Parts>
std::string text_of(const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  return text.str();
}

/// Also of 1.7e9 seconds.
std::string tenths(double seconds) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << seconds;
  return text.str();
}

steady_clock::time_point after(double seconds) {
  return steady_clock::now() +
         std::chrono::duration_cast<steady_clock::duration>(std::chrono::duration<double>(seconds));
}

/// What a message of this topic is read as; errors get the topic's name.
template <class Read>
auto reading(const Reader& reader, Read&& read) {
  try {
    return read();
  } catch (const Error& error) {
    throw Error(Fault::kData, error.what(), reader.topic());
  }
}

CameraModel with_depth_factor(CameraModel model, double depth_factor) {
  if (depth_factor > 0) model.depth_factor = depth_factor;
  return model;
}

}  // namespace

void Ros2Source::Options::visit(OptionVisitor& v) {
  v("color_topic", color_topic, {.help = "topic of the colour images, sensor_msgs/Image"});
  v("depth_topic", depth_topic,
    {.help = "topic of the depth images, sensor_msgs/Image, registered to the colour images and as "
             "large"});
  v("info_topic", info_topic,
    {.help = "topic of the colour images' sensor_msgs/CameraInfo; not used with a camera section"});
  v("domain", domain,
    {.min = -1, .max = 232, .help = "DDS domain; -1: that of ROS_DOMAIN_ID, or 0"});
  v("reliable", reliable,
    {.help = "quality of service: true has lost packets sent again, but does not hear best-effort "
             "publishers, as most cameras are"});
  v("queue_size", queue_size,
    {.min = 1,
     .max = 10000,
     .unit = "images",
     .help = "images of a topic that may wait; older ones are dropped"});
  v("approximate", approximate,
    {.help = "pair images whose stamps differ by up to max_difference; false: only equal stamps"});
  v("max_difference", max_difference,
    {.min = 0,
     .max = 1,
     .unit = "s",
     .help = "largest time difference of a colour and a depth image in a pair, if approximate; at "
             "most 0.6 of the time from one image to the next"});
  v("rectified", rectified,
    {.help = "the images are rectified: use the matrix P of CameraInfo instead of K and D"});
  v("registered", registered,
    {.help =
         "take the depth images as registered to colour, although their frame_id says otherwise"});
  v("depth_factor", depth_factor,
    {.min = 0,
     .max = 1e9,
     .help = "value of one metre in 16-bit depth images; 0: that of the camera section, or 1000 "
             "(millimetres, as ROS has it)"});
  v("timeout", timeout,
    {.min = 0.1,
     .max = 86400,
     .unit = "s",
     .help = "time without images: an error before the first pair, the end of the run after it"});
  v("limit", limit, {.min = 0, .unit = "frames", .help = "frames to read; 0 for no limit"});
}

Ros2Source::Ros2Source(const Options& options, const StageContext& context)
    : options_(options),
      camera_file_(context.camera),
      log_(context.log),
      participant_(options.domain),
      color_reader_(participant_, options.color_topic, bag::kImageType, options.queue_size,
                    options.reliable),
      depth_reader_(participant_, options.depth_topic, bag::kImageType, options.queue_size,
                    options.reliable) {
  if (context.camera)
    rectifier_.emplace(with_depth_factor(*context.camera, options.depth_factor));
  else
    info_reader_.emplace(participant_, options.info_topic, bag::kCameraInfoType, 1,
                         options.reliable);
  log_(LogLevel::kInfo, "waiting for " + options.color_topic + " and " + options.depth_topic);
}

void Ros2Source::wait_for_camera() {
  const auto message = info_reader_->take(after(options_.timeout), stop_);
  if (!message && stop_.stop_requested()) return;
  if (!message) fail(*info_reader_);
  const CameraModel model = reading(*info_reader_, [&] {
    return bag::camera_model(bag::read_camera_info(*message, bag::Serialisation::kCdr),
                             options_.rectified, options_.info_topic);
  });
  rectifier_.emplace(with_depth_factor(model, options_.depth_factor));
}

bool Ros2Source::wait_for(std::optional<Image>& image, const Reader& reader, Kind kind) {
  if (image) return true;
  const auto bytes = reader.take(after(options_.timeout), stop_);
  if (!bytes) return false;
  image = reading(reader, [&] {
    const bag::ImageMessage message = bag::read_image(*bytes, bag::Serialisation::kCdr, false);
    const cv::Mat pixels =
        kind == Kind::kColor ? bag::color_pixels(message) : bag::depth_pixels(message);
    const bag::MessageHeader& header = message.description.header;
    return Image{bag::seconds(header.stamp), header.frame, pixels.clone()};
  });
  (kind == Kind::kColor ? color_period_ : depth_period_).add(image->stamp);
  return true;
}

std::optional<Frame> Ros2Source::next() {
  if (options_.limit > 0 && given_ == static_cast<std::uint32_t>(options_.limit)) ended_ = true;
  if (!ended_ && !rectifier_) wait_for_camera();
  while (!ended_ && !stop_.stop_requested()) {
    const bool has_color = wait_for(color_, color_reader_, Kind::kColor);
    if (!has_color || !wait_for(depth_, depth_reader_, Kind::kDepth)) {
      if (stop_.stop_requested()) return std::nullopt;
      if (given_ == 0) fail(has_color ? depth_reader_ : color_reader_);
      log_(LogLevel::kWarning,
           text_of("no images for ", options_.timeout, " s: this is taken for the end"));
      ended_ = true;
    } else if (auto frame = frame_of_waiting()) {
      return frame;
    }
  }
  return std::nullopt;
}

bool Ros2Source::is_pair() {
  const double ahead = color_->stamp - depth_->stamp;
  const double apart = std::abs(ahead);
  const double limit =
      options_.approximate
          ? live_camera::pairing_limit(options_.max_difference, color_period_, depth_period_)
          : 0.0;
  if (apart <= limit) return true;
  if (ahead < 0) missing_.add(color_->stamp + shift_);  // it did come
  unpaired_depth_ += ahead > 0 ? 1 : 0;
  // The later one would wait for ever for a clock that was set back: both go.
  const bool two_clocks = apart > kStepBack && goes_back(std::min(color_->stamp, depth_->stamp));
  if (ahead < 0 || two_clocks) color_.reset();
  if (ahead > 0 || two_clocks) depth_.reset();
  unpaired_ += two_clocks ? 2 : 1;
  if (given_ == 0 && unpaired_ % 100 == 0)
    log_(LogLevel::kWarning,
         text_of(unpaired_, " images, and no two with the same stamp: set source.approximate"));
  return false;
}

void Ros2Source::check_first_pair(const Image& color, const Image& depth) const {
  if (!options_.registered &&
      !bag::is_registered({options_.color_topic, color.frame}, {options_.depth_topic, depth.frame}))
    throw Error(Fault::kData,
                "the depth images are in the frame '" + depth.frame + "', those of " +
                    options_.color_topic + " in '" + color.frame +
                    "': they are not registered to the colour images, and this source does not "
                    "register them",
                options_.depth_topic,
                "subscribe registered depth (align_depth, depth_registered); if it is registered, "
                "set source.registered=true");
  if (!camera_file_ || options_.depth_factor > 0 || depth.pixels.type() != CV_16UC1) return;
  const std::string warning = bag::depth_factor_warning(*camera_file_);
  if (!warning.empty()) log_(LogLevel::kWarning, warning);
}

std::optional<Frame> Ros2Source::frame_of_waiting() {
  if (!is_pair()) return std::nullopt;
  const Image color = *std::exchange(color_, std::nullopt);
  const Image depth = *std::exchange(depth_, std::nullopt);
  if (given_ == 0) check_first_pair(color, depth);
  if (goes_back(color.stamp)) go_on_from(color.stamp);
  const double time = color.stamp + shift_;
  if (given_ > 0 && time <= last_time_) {
    ++backwards_;
    return std::nullopt;
  }
  Frame frame =
      reading(color_reader_, [&] { return rectifier_->frame(time, color.pixels, depth.pixels); });
  frame.index = given_++;
  last_time_ = frame.time;
  missing_.add(frame.time);
  if (given_ % kFramesPerCount == 0) left_out_ = count_left_out();
  return frame;
}

bool Ros2Source::goes_back(double stamp) const {
  return given_ > 0 && stamp + shift_ < last_time_ - kStepBack;
}

void Ros2Source::go_on_from(double stamp) {
  const double step = last_time_ - (stamp + shift_);
  shift_ = last_time_ + missing_.period() - stamp;
  ++returns_;
  log_(LogLevel::kWarning,
       text_of("the stamps went back by ", tenths(step),
               " s: a clock was set back, or a bag is played again; times go on, from here on ",
               tenths(shift_), " s later than the stamps"));
}

void Ros2Source::fail(const Reader& missing) const {
  const int writers = missing.writers();
  throw Error(Fault::kData,
              text_of("no message for ", options_.timeout, " s; publishers: ", writers,
                      unpaired_ > 0 ? text_of("; images without partner: ", unpaired_) : ""),
              missing.topic(),
              writers > 0
                  ? "see whether they publish, with the same stamps for colour and depth, or "
                    "set source.approximate"
                  : "compare topic, domain and reliability with those of the publishers; "
                    "source.timeout is how long to wait");
}

// Where the times of colour images have a gap, an image never came. If its depth image did, that
// one had no partner, and has been counted.
std::size_t Ros2Source::count_missing() const {
  const std::size_t gaps = missing_.count();
  return gaps > unpaired_depth_ ? gaps - unpaired_depth_ : 0;
}

std::size_t Ros2Source::count_left_out() const { return unpaired_ + backwards_ + count_missing(); }

SourceReport Ros2Source::report() const {
  SourceReport report;
  const std::size_t missing = count_missing();
  report.skipped = count_left_out();
  if (missing > 0)
    report.warnings.push_back(
        text_of("about ", missing,
                " frames are missing, if the camera has a constant rate: lost on the way, or newer "
                "ones came before they could be used (queue_size, reliable)"));
  if (unpaired_ > 0)
    report.warnings.push_back(text_of(unpaired_, " images had no partner of the same time"));
  if (returns_ > 0)
    report.warnings.push_back(text_of("the stamps went back by more than a second, ", returns_,
                                      returns_ == 1 ? " time" : " times",
                                      ": later poses have times that are up to ", tenths(shift_),
                                      " s later than the stamps of their images"));
  if (backwards_ > 0)
    report.warnings.push_back(
        text_of(backwards_, " pairs of images were not later than the one before"));
  return report;
}

}  // namespace stillpoint::ros2
