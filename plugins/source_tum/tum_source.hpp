// Frames of a recording on disk (TUM RGB-D benchmark, Bonn RGB-D Dynamic).
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "stillpoint/sdk.hpp"
#include "stillpoint/support/rectifier.hpp"
#include "tum_recording/image_reader.hpp"
#include "tum_recording/recording.hpp"

namespace stillpoint::source_tum {

using tum_recording::ImagePair;
using tum_recording::ImageReader;
using tum_recording::Recording;
using tum_recording::RecordingOptions;

/// Images that cannot be used are skipped and reported. Gives up with Error(kData) when the first
/// ten are all unusable, or more than half.
class TumSource final : public Source {
 public:
  struct Options {
    std::string path;
    RecordingOptions pairing;
    int start = 0;   ///< first pair
    int end = 0;     ///< one past the last pair, 0 = all
    int stride = 1;  ///< every n-th pair
    int limit = 0;   ///< largest number of frames, 0 = no limit

    void visit(OptionVisitor& visitor);
  };

  TumSource(Options options, const StageContext& context);

  std::optional<Frame> next() override;
  std::optional<std::size_t> size() const override { return recording_.pairs.size(); }
  SourceReport report() const override { return report_; }
  std::filesystem::path ground_truth() const override { return recording_.ground_truth; }

 private:
  Frame load(const ImagePair& pair);
  void skip(const Error& reason);

  Recording recording_;
  CameraModel model_;
  Rectifier rectifier_;
  std::function<void(LogLevel, std::string_view)> log_;
  ImageReader reader_;
  std::size_t position_ = 0;  // in recording_.pairs
  std::uint32_t given_ = 0;   // frames returned by next()
  SourceReport report_;
};

}  // namespace stillpoint::source_tum
