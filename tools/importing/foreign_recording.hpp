// A recording in the layout of another data set, as it is read to be imported.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "stillpoint/contracts/camera.hpp"
#include "stillpoint/pose_math.hpp"

namespace stillpoint::importing {

/// An image as it goes into the new recording: a file that stays as it is, or the bytes of a new
/// one.
struct StoredImage {
  double time = 0.0;                ///< seconds
  std::filesystem::path file;       ///< empty: `bytes`
  std::vector<std::uint8_t> bytes;  ///< of an image file
  std::string extension = ".png";   ///< of that file
};

/// What one step of reading gives; where the streams have their own lists, one may end first.
struct ForeignFrame {
  std::optional<StoredImage> color;
  std::optional<StoredImage> depth;  ///< 16 bit, of the colour camera, 0 where nothing was measured
};

/// Read from front to back, by one thread.
class ForeignRecording {
 public:
  virtual ~ForeignRecording() = default;

  virtual std::size_t size() const = 0;  ///< steps of reading
  /// Throws Error(kData) naming the file and what is wrong with it.
  virtual ForeignFrame read(std::size_t index) = 0;

  /// Of the images that read() gives.
  const CameraModel& camera() const { return camera_; }
  /// True poses of the colour camera by strictly rising time; empty when there are none.
  const std::vector<StampedPose>& truth() const { return truth_; }
  /// What a user should know of the recording or of its import; one line each.
  const std::vector<std::string>& notes() const { return notes_; }

 protected:
  CameraModel camera_;
  std::vector<StampedPose> truth_;
  std::vector<std::string> notes_;
};

struct ImportOptions {
  /// Of the colour images: the user's, or that of the data set; nothing: the recording brings it.
  std::optional<CameraModel> camera;
  bool camera_is_users = false;  ///< depth is then taken for registered to it
  std::size_t most_frames = std::numeric_limits<std::size_t>::max();
};

}  // namespace stillpoint::importing
