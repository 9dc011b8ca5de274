// Recordings whose images stay as they are: two lists of files.
#pragma once

#include <algorithm>
#include <filesystem>
#include <vector>

#include "importing/foreign_recording.hpp"
#include "tum_recording/stamp_list.hpp"

namespace stillpoint::importing {

class ListedRecording final : public ForeignRecording {
 public:
  struct Lists {
    std::vector<tum_recording::StampedImage> color, depth;
    std::vector<StampedPose> truth;
    std::vector<std::string> notes;
  };

  /// Throws Error(kData) when a list is empty or the first images do not fit the camera.
  ListedRecording(Lists lists, const CameraModel& camera, std::size_t most_frames);

  std::size_t size() const override;
  ForeignFrame read(std::size_t index) override;

 private:
  std::vector<tum_recording::StampedImage> color_, depth_;
};

/// Images or poses by strictly rising time, however they came; of several of one time the first.
template <class Stamped>
std::vector<Stamped> sorted_by_time(std::vector<Stamped> all) {
  std::ranges::stable_sort(all, {}, &Stamped::time);
  const auto same = [](const Stamped& a, const Stamped& b) { return a.time == b.time; };
  all.erase(std::unique(all.begin(), all.end(), same), all.end());
  return all;
}

/// A line of `time tx ty tz qx qy qz qw`. Throws Error(kData) with file and line.
StampedPose tum_pose_of(const tum_recording::ListLine& line, const std::filesystem::path& file);

}  // namespace stillpoint::importing
