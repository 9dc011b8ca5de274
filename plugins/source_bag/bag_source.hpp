// Frames of a bag of ROS 1 or ROS 2.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bag/bag_images.hpp"
#include "bag/bag_reader.hpp"
#include "source_bag/frame_maker.hpp"
#include "stillpoint/sdk.hpp"
#include "tum_recording/image_decoder.hpp"
#include "tum_recording/pair_selection.hpp"
#include "tum_recording/skipped_pairs.hpp"

namespace stillpoint::source_bag {

/// Images that cannot be used are skipped and reported. Gives up with Error(kData) when the first
/// ten are all unusable, or more than half.
class BagSource final : public Source {
 public:
  struct Options {
    std::string path;
    bag::TopicNames topics;
    double max_difference = 0.02;  ///< seconds
    double time_offset = 0.0;      ///< seconds, added to the stamps of depth images
    bool registered = false;       ///< depth is, whatever its frame says
    double depth_factor = 0.0;     ///< of 16-bit depth, value of one metre; 0: the camera's
    tum_recording::PairSelection selection;

    void visit(OptionVisitor& visitor);
  };

  BagSource(Options options, const StageContext& context);

  std::optional<Frame> next() override;
  std::optional<std::size_t> size() const override { return pairs_.size(); }
  SourceReport report() const override { return skipped_.report(); }

 private:
  struct Pair {
    bag::ImageStamp color, depth;
  };

  std::vector<Pair> make_pairs(const Options& options);
  /// Of 16-bit depth and a camera that the bag does not know of.
  void check_depth_factor(const CameraModel& camera_file);
  Frame load(const Pair& pair);

  std::unique_ptr<bag::BagReader> bag_;
  bag::TopicChoice choice_;
  FrameMaker maker_;
  std::vector<std::string> notes_;  // of what making the pairs left out
  std::vector<Pair> pairs_;
  tum_recording::SkippedPairs skipped_;
  bag::BagImages<tum_recording::ImageDecoder> images_;
  std::size_t position_ = 0;  // in pairs_
  std::uint32_t given_ = 0;   // frames returned by next()
};

}  // namespace stillpoint::source_bag
