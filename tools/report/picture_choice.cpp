#include "report/picture_choice.hpp"

#include <algorithm>
#include <charconv>
#include <map>
#include <utility>

#include "evaluation/format.hpp"
#include "report/worst_moments.hpp"
#include "stillpoint/error.hpp"
#include "tum_recording/recording.hpp"

namespace stillpoint::report {
namespace {

namespace fs = std::filesystem;
using evaluation::fixed;

constexpr std::size_t kEven = 4;
constexpr double kSameTime = 1e-4;  // seconds; frames.csv has microseconds

using Pictures = std::map<std::uint32_t, fs::path>;  // by frame

Pictures pictures_in(const fs::path& folder) {
  Pictures pictures;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none)) {
    const fs::path& file = entry.path();
    if (file.extension() != ".jpg" && file.extension() != ".png") continue;
    const std::string stem = file.stem().string();
    std::uint32_t frame = 0;
    const auto [end, error] = std::from_chars(stem.data(), stem.data() + stem.size(), frame);
    if (error == std::errc() && end == stem.data() + stem.size()) pictures[frame] = file;
  }
  return pictures;
}

/// The picture of the frame, or the nearest one: not every frame has one.
std::uint32_t nearest(const Pictures& pictures, std::uint32_t frame) {
  auto after = pictures.lower_bound(frame);
  if (after == pictures.end()) return std::prev(after)->first;
  if (after == pictures.begin()) return after->first;
  const auto before = std::prev(after);
  return after->first - frame < frame - before->first ? after->first : before->first;
}

/// "80 of 120 matches fit, 5 points move, 12.0 % not used"
std::string state_of(const FrameRow& row) {
  if (!row.tracked) return "no pose, " + std::to_string(row.features) + " features";
  std::string text =
      std::to_string(row.inliers) + " of " + std::to_string(row.matches) + " matches fit";
  if (row.moving_points) text += ", " + std::to_string(*row.moving_points) + " points move";
  return text + ", " + fixed(100 * row.excluded, 1) + " % not used";
}

const FrameRow* row_of(const RunData& run, std::uint32_t frame) {
  const auto row = std::ranges::lower_bound(run.frame_rows, frame, {}, &FrameRow::frame);
  return row == run.frame_rows.end() || row->frame != frame ? nullptr : &*row;
}

/// The colour images of a recording, none where it is no folder of the TUM format.
std::vector<tum_recording::StampedImage> recorded_images(const fs::path& recording) {
  try {
    return tum_recording::open_recording(recording).color;
  } catch (const Error&) {
    return {};
  }
}

/// Empty when there is none of that time.
fs::path image_at(const std::vector<tum_recording::StampedImage>& images, double time) {
  const auto image =
      std::ranges::lower_bound(images, time - kSameTime, {}, &tum_recording::StampedImage::time);
  return image == images.end() || image->time > time + kSameTime ? fs::path() : image->file;
}

/// Chosen pictures, by frame.
class Choice {
 public:
  Choice(const RunData& run, Pictures drawn)
      : run_(run), drawn_(std::move(drawn)), recorded_(recorded_images(run.dataset)) {}

  void add_even_ones() {
    const std::size_t count = std::min(kEven, drawn_.size());
    for (std::size_t i = 0; i < count; ++i)
      add_drawn(std::next(drawn_.begin(),
                          static_cast<std::ptrdiff_t>((2 * i + 1) * drawn_.size() / (2 * count)))
                    ->first);
  }

  void add(const WorstMoment& moment) {
    if (drawn_.contains(moment.frame)) return add_why(add_drawn(moment.frame), moment.why);
    if (!moment.first) return;
    const FrameRow* row = row_of(run_, moment.frame);
    const fs::path image = row ? image_at(recorded_, row->time) : fs::path();
    if (!image.empty()) {
      Picture& picture = chosen_[moment.frame];
      picture.file = image;
      picture.recorded = true;
      add_why(picture, moment.why);
    } else if (!drawn_.empty()) {
      add_why(add_drawn(nearest(drawn_, moment.frame)),
              moment.why + " (in frame " + std::to_string(moment.frame) + ")");
    }
  }

  std::vector<Picture> pictures() && {
    std::vector<Picture> pictures;
    for (auto& [frame, picture] : chosen_) {
      picture.frame = frame;
      if (const FrameRow* row = row_of(run_, frame)) picture.state = state_of(*row);
      pictures.push_back(std::move(picture));
    }
    return pictures;
  }

 private:
  Picture& add_drawn(std::uint32_t frame) {
    Picture& picture = chosen_[frame];
    picture.file = drawn_.at(frame);
    return picture;
  }

  static void add_why(Picture& picture, const std::string& why) {
    picture.why += (picture.why.empty() ? "" : "; ") + why;
  }

  const RunData& run_;
  const Pictures drawn_;
  const std::vector<tum_recording::StampedImage> recorded_;
  std::map<std::uint32_t, Picture> chosen_;
};

}  // namespace

void choose_pictures(RunData& run) {
  Choice choice(run, pictures_in(run.folder / "images"));
  choice.add_even_ones();
  for (const WorstMoment& moment : worst_moments(run)) choice.add(moment);
  run.pictures = std::move(choice).pictures();
}

}  // namespace stillpoint::report
