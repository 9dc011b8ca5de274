#include "report/picture_choice.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

#include "evaluation/format.hpp"

namespace stillpoint::report {
namespace {

namespace fs = std::filesystem;
using evaluation::fixed;

constexpr std::size_t kEven = 4;

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

const FrameRow* row_at(const RunData& run, double seconds) {
  const auto row = std::ranges::min_element(
      run.frame_rows, {}, [&](const FrameRow& r) { return std::abs(r.seconds - seconds); });
  return row == run.frame_rows.end() ? nullptr : &*row;
}

/// Frames that somebody should look at, and why; less urgent ones last.
std::vector<std::pair<std::uint32_t, std::string>> worst_moments(const RunData& run) {
  std::vector<std::pair<std::uint32_t, std::string>> moments;
  if (run.frame_rows.empty()) return moments;
  if (!run.lost.empty())
    if (const FrameRow* row = row_at(run, run.lost.front().begin))
      moments.emplace_back(row->frame, "lost at " + fixed(row->seconds, 2) + " s");
  if (const auto worst = std::ranges::max_element(run.trace, {}, &TracePoint::error_m);
      worst != run.trace.end())
    if (const FrameRow* row = row_at(run, worst->seconds))
      moments.emplace_back(row->frame, "largest error: " + fixed(1000 * worst->error_m, 1) + " mm");
  const auto excluded = std::ranges::max_element(run.frame_rows, {}, &FrameRow::excluded);
  if (excluded->excluded > 0.0)
    moments.emplace_back(excluded->frame,
                         "most excluded: " + fixed(100 * excluded->excluded, 1) + " %");
  const auto tracked = [](const FrameRow& r) {
    return r.tracked && r.matches > 0 ? r.inliers : 1 << 30;
  };
  const auto fewest = std::ranges::min_element(run.frame_rows, {}, tracked);
  if (fewest->tracked && fewest->matches > 0)
    moments.emplace_back(fewest->frame, "fewest inliers: " + std::to_string(fewest->inliers));
  return moments;
}

}  // namespace

void choose_pictures(RunData& run) {
  const Pictures pictures = pictures_in(run.folder / "images");
  if (pictures.empty()) return;
  std::map<std::uint32_t, std::string> chosen;
  const std::size_t even = std::min(kEven, pictures.size());
  for (std::size_t i = 0; i < even; ++i)
    chosen[std::next(pictures.begin(),
                     static_cast<std::ptrdiff_t>((2 * i + 1) * pictures.size() / (2 * even)))
               ->first];
  for (const auto& [frame, why] : worst_moments(run)) {
    const std::uint32_t shown = nearest(pictures, frame);
    std::string& reason = chosen[shown];
    reason += (reason.empty() ? "" : "; ") + why +
              (shown == frame ? "" : " (in frame " + std::to_string(frame) + ")");
  }
  for (const auto& [frame, why] : chosen) run.pictures.push_back({frame, pictures.at(frame), why});
}

}  // namespace stillpoint::report
