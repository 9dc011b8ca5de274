// Frames of a recording on disk (TUM RGB-D benchmark, Bonn RGB-D Dynamic).
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "stillpoint/sdk.hpp"
#include "stillpoint/support/rectifier.hpp"
#include "tum_recording/image_reader.hpp"
#include "tum_recording/pair_selection.hpp"
#include "tum_recording/recording.hpp"
#include "tum_recording/skipped_pairs.hpp"

namespace stillpoint::source_tum {

using tum_recording::ImagePair;
using tum_recording::ImageReader;
using tum_recording::PairSelection;
using tum_recording::Recording;
using tum_recording::RecordingOptions;
using tum_recording::SkippedPairs;

/// Images that cannot be used are skipped and reported. Gives up with Error(kData) when the first
/// ten are all unusable, or more than half.
class TumSource final : public Source {
 public:
  struct Options {
    std::string path;
    RecordingOptions pairing;
    PairSelection selection;

    void visit(OptionVisitor& visitor);
  };

  TumSource(Options options, const StageContext& context);

  std::optional<Frame> next() override;
  std::optional<std::size_t> size() const override { return recording_.pairs.size(); }
  SourceReport report() const override { return skipped_.report(); }
  std::filesystem::path ground_truth() const override { return recording_.ground_truth; }

 private:
  Frame load(const ImagePair& pair);

  Recording recording_;
  CameraModel model_;
  Rectifier rectifier_;
  ImageReader reader_;
  std::size_t position_ = 0;  // in recording_.pairs
  std::uint32_t given_ = 0;   // frames returned by next()
  SkippedPairs skipped_;
};

}  // namespace stillpoint::source_tum
