#include "live_camera/live_frames.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <iomanip>
#include <mutex>
#include <sstream>
#include <utility>

#include "stillpoint/support/size_text.hpp"

namespace stillpoint::live_camera {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr milliseconds kBetweenAttempts(500);

template <class... Parts>
std::string text_of(const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  return text.str();
}

std::string tenths(double seconds) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << seconds;
  return text.str();
}

milliseconds duration_of(double seconds) { return milliseconds(std::lround(1000 * seconds)); }

milliseconds until(steady_clock::time_point deadline) {
  const auto rest = std::chrono::ceil<milliseconds>(deadline - steady_clock::now());
  return std::max(rest, milliseconds::zero());
}

/// Ends early when a stop is requested.
void pause_for(milliseconds time, std::stop_token stop) {
  std::mutex mutex;
  std::condition_variable_any stopped;
  std::unique_lock lock(mutex);
  stopped.wait_for(lock, std::move(stop), time, [] { return false; });
}

}  // namespace

void LiveOptions::visit(OptionVisitor& v) {
  v("max_difference", max_difference,
    {.min = 0.001,
     .max = 1,
     .unit = "s",
     .help = "largest time difference of a colour and a depth image in a pair; at most 0.6 of the "
             "time from one image to the next"});
  v("timeout", timeout,
    {.min = 0.1,
     .max = 3600,
     .unit = "s",
     .help = "time without images after which the camera counts as gone"});
  v("reconnect_for", reconnect_for,
    {.min = 0,
     .max = 86400,
     .unit = "s",
     .help = "time in which a camera that is gone is looked for again; 0: the run ends at once"});
  v("limit", limit, {.min = 0, .unit = "frames", .help = "frames to read; 0 for no limit"});
}

CameraModel live_model(const StageContext& context, const std::string& device, int width,
                       int height, double field_of_view) {
  CameraModel model;
  if (context.camera) {
    model = *context.camera;
  } else {
    if (field_of_view <= 0)
      throw Error(Fault::kUsage,
                  "no camera is given, and the device does not tell its field of view", device,
                  "name a camera file with --camera");
    model.name = device;
    model.width = width;
    model.height = height;
    model.fx = model.fy = width / 2.0 / std::tan(field_of_view / 2);
    model.cx = (width - 1) / 2.0;
    model.cy = (height - 1) / 2.0;
    context.log(
        LogLevel::kWarning,
        text_of(device, ": no calibration is given: taking an ideal camera with a focal length of ",
                std::lround(model.fx), " px; lengths may be wrong by some percent (name a ",
                "camera file with --camera)"));
  }
  if (model.width != width || model.height != height)
    throw Error(
        Fault::kUsage,
        text_of("the camera sends ", size_text({width, height}), " pixels, but '", model.name,
                "' is a calibration for ", size_text({model.width, model.height})),
        device, "name another camera file with --camera");
  model.depth_factor = 1000.0;
  return model;
}

LiveFrames::LiveFrames(const LiveOptions& options, const CameraModel& model, std::string device,
                       double ticks_per_second, int counter_bits,
                       std::function<void(LogLevel, std::string_view)> log)
    : options_(options),
      rectifier_(model),
      device_(std::move(device)),
      clock_(ticks_per_second, counter_bits),
      pairs_(options.max_difference),
      log_(std::move(log)) {}

void LiveFrames::put_color(std::uint64_t ticks, cv::Mat bgr) {
  pairs_.put_color(clock_.seconds(ticks, host_seconds()), std::move(bgr));
}

void LiveFrames::put_depth(std::uint64_t ticks, cv::Mat depth) {
  pairs_.put_depth(clock_.seconds(ticks, host_seconds()), std::move(depth));
}

std::optional<Frame> LiveFrames::next(LiveDriver& driver) {
  if (options_.limit > 0 && given_ == static_cast<std::uint32_t>(options_.limit))
    return std::nullopt;
  if (!started_) driver.start();
  started_ = true;
  while (auto pair = next_pair(driver)) {
    if (given_ > 0 && pair->seconds <= last_seconds_) {  // the device's clock was compared anew
      ++late_;
      continue;
    }
    Frame frame = rectifier_.frame(pair->seconds, pair->bgr, pair->depth);
    frame.index = given_++;
    last_seconds_ = pair->seconds;
    return frame;
  }
  return std::nullopt;
}

std::optional<LivePair> LiveFrames::next_pair(LiveDriver& driver) {
  if (auto pair = pairs_.take(duration_of(options_.timeout), stop_)) return pair;
  if (stop_.stop_requested()) return std::nullopt;
  const auto gone_since = steady_clock::now();
  std::string why = pairs_.why_ended();
  if (why.empty())
    why = text_of("no pair of images for ", options_.timeout, " s, after ", given_, " frames");
  if (given_ > 0 && options_.reconnect_for > 0) {
    log_(LogLevel::kWarning, text_of(device_, ": ", why, "; trying to open it again for ",
                                     options_.reconnect_for, " s"));
    auto pair = reconnected(driver, gone_since + duration_of(options_.reconnect_for));
    if (pair) {
      const double away = std::chrono::duration<double>(steady_clock::now() - gone_since).count();
      ++absences_;
      seconds_away_ += away;
      log_(LogLevel::kWarning,
           text_of(device_, ": the camera is back, after ", tenths(away), " s"));
    }
    if (pair || stop_.stop_requested()) return pair;
    why += text_of(", and it was not back after ", options_.reconnect_for, " s");
  }
  throw Error(Fault::kData, why, device_,
              "check that it is plugged in, powered and used by no other program");
}

std::optional<LivePair> LiveFrames::reconnected(LiveDriver& driver,
                                                steady_clock::time_point deadline) {
  std::optional<LivePair> pair;
  do {
    pause_for(std::min(kBetweenAttempts, until(deadline)), stop_);
    if (stop_.stop_requested()) break;
    if (restarted(driver))
      pair = pairs_.take(std::min(duration_of(options_.timeout), until(deadline)), stop_);
  } while (!pair && steady_clock::now() < deadline);
  return pair;
}

bool LiveFrames::restarted(LiveDriver& driver) {
  driver.close();
  pairs_.restart();
  clock_.restart();
  try {
    driver.start();
  } catch (const Error&) {  // it is not there yet
    return false;
  }
  return true;
}

std::size_t LiveFrames::left_out() const { return pairs_.dropped() + pairs_.unpaired() + late_; }

SourceReport LiveFrames::report() const {
  SourceReport report;
  const int clock_jumps = clock_.jumps();
  const std::size_t dropped = pairs_.dropped();
  const std::size_t unpaired = pairs_.unpaired();
  report.skipped = left_out();
  if (dropped > 0)
    report.warnings.push_back(
        text_of(device_, ": ", dropped,
                " pairs of images came while two were waiting for tracking, and were dropped"));
  if (unpaired > 0)
    report.warnings.push_back(text_of(device_, ": ", unpaired, " images had no partner within ",
                                      1000 * options_.max_difference,
                                      " ms (source.max_difference) and ", kLargestShare,
                                      " of the time from one image to the next"));
  if (late_ > 0)
    report.warnings.push_back(
        text_of(device_, ": ", late_, " pairs of images were older than the frame before"));
  if (absences_ > 0)
    report.warnings.push_back(text_of(device_, ": the camera was gone ", absences_,
                                      absences_ == 1 ? " time" : " times", ", for ",
                                      tenths(seconds_away_), " s in all, and came back"));
  if (clock_jumps > 0)
    report.warnings.push_back(
        text_of(device_, ": the device's clock jumped ", clock_jumps, " times"));
  for (const std::string& warning : report.warnings) log_(LogLevel::kWarning, warning);
  return report;
}

}  // namespace stillpoint::live_camera
