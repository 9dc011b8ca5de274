// The folder that an import writes: one of the TUM RGB-D benchmark.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <stop_token>
#include <string>

#include "importing/foreign_recording.hpp"

namespace stillpoint::importing {

/// rgb/, depth/, rgb.txt, depth.txt, groundtruth.txt, camera.yaml. Complete or not there: it is
/// written as FOLDER.partial and renamed at the end; without commit(), nothing is left.
class RecordingFolder {
 public:
  /// Throws Error(kUsage) when there is such a folder already or it cannot be made.
  explicit RecordingFolder(const std::filesystem::path& folder);
  ~RecordingFolder();
  RecordingFolder(const RecordingFolder&) = delete;
  RecordingFolder& operator=(const RecordingFolder&) = delete;

  /// Files are hard-linked, or copied where that is not possible. Throws Error(kUsage) when there
  /// is no room.
  void add(const ForeignFrame& frame);
  /// Throws Error(kUsage) when there is no room.
  void commit(std::span<const StampedPose> truth, const std::string& camera_yaml);
  /// As without commit(), before the end of the scope.
  void discard();

  std::size_t linked() const { return linked_; }    ///< images
  std::size_t copied() const { return copied_; }    ///< images
  std::size_t written() const { return written_; }  ///< images that are no longer what they were

 private:
  void store(const StoredImage& image, const char* stream, std::string& list);
  void write(const std::filesystem::path& name, const std::string& text) const;

  std::filesystem::path folder_;
  std::filesystem::path partial_;
  std::string colors_, depths_;  // the lists
  std::size_t linked_ = 0, copied_ = 0, written_ = 0;
};

/// All frames into `folder`, then `progress` after each with their number. False when a stop was
/// requested before the end.
bool add_frames(ForeignRecording& recording, RecordingFolder& folder, const std::stop_token& stop,
                const std::function<void(std::size_t frames)>& progress);

}  // namespace stillpoint::importing
