#include "progress.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

namespace stillpoint {
namespace {

using namespace std::chrono_literals;

constexpr int kLargestBar = 30;

// The text, cut to the width of the terminal, behind as much of a bar as has room.
std::string with_bar(double share, const std::string& text, int columns) {
  const int room = columns - 3 - static_cast<int>(text.size());
  const int width = std::clamp(room, 0, kLargestBar);
  const int full = static_cast<int>(share * width + 0.5);
  std::string line;
  for (int i = 0; i < width; ++i) line += i < full ? "█" : "░";
  return line + "  " + text.substr(0, static_cast<std::size_t>(std::max(0, columns - 3)));
}

}  // namespace

Progress::Progress(Console& console, std::optional<std::size_t> frames, Of what)
    : console_(console), frames_(frames && *frames > 0 ? frames : std::nullopt), what_(what) {}

void Progress::frame(const FrameReport& report) {
  done_ = report.frame->index + 1;
  ++processed_;
  if (report.result.keyframe) ++keyframes_;
  left_out_ = report.left_out;
  const Clock::time_point now = Clock::now();
  if (!due(now)) return;
  last_shown_ = now;
  last_share_ = share();
  const std::string text =
      describe(std::chrono::duration<double>(now - start_).count(), report.result);
  if (!console_.is_terminal())
    console_.line(text);
  else
    console_.status(with_bar(share(), text, console_.columns()));
}

bool Progress::due(Clock::time_point now) const {
  if (console_.is_terminal()) return now - last_shown_ > 100ms;
  return now - last_shown_ > 5s || share() - last_share_ >= 0.1 - 1e-9;
}

double Progress::share() const {
  return frames_ ? std::min(1.0, static_cast<double>(done_) / static_cast<double>(*frames_)) : 0.0;
}

std::string Progress::describe(double seconds, const TrackResult& result) const {
  const double rate = static_cast<double>(processed_) / std::max(seconds, 1e-9);
  std::array<char, 160> text{};
  if (frames_)
    std::snprintf(text.data(), text.size(), "%zu/%zu  %3.0f %%  %.1f frames/s  %s left", done_,
                  *frames_, 100.0 * share(), rate,
                  minutes(seconds / share() * (1.0 - share())).c_str());
  else
    std::snprintf(text.data(), text.size(), "%zu  %.1f frames/s", done_, rate);
  std::string line = text.data();
  if (what_ == Of::kTracking)
    line += "  " + std::to_string(keyframes_) + " key frames  " + name_of(result.state);
  if (left_out_ > 0) line += "  " + std::to_string(left_out_) + " left out";
  return line;
}

}  // namespace stillpoint
