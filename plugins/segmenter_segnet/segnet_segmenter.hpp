// The paper's segmentation (III-B): SegNet trained on PASCAL VOC.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "segmenter_segnet/segnet_network.hpp"
#include "stillpoint/sdk.hpp"

namespace stillpoint::segmenter_segnet {

/// Labels of the network's size are enlarged to the frame's with the nearest pixel, as SegNet's own
/// programs do.
class SegnetSegmenter final : public Segmenter {
 public:
  enum class ChannelOrder { kBgr, kRgb };
  struct Options {
    std::string prototxt;
    std::string model;
    std::vector<std::string> classes = {"voc21"};  ///< a list by its name, or the names
    ChannelOrder channels = ChannelOrder::kBgr;    ///< of the network's input
    std::vector<double> mean = {0};                ///< of the network's channels; subtracted first
    double scale = 1.0;                            ///< of pixels 0 … 255 minus the mean
    int min_object_pixels = 100;                   ///< of the frame
    int threads = 0;                               ///< of OpenCV; 0: as the runtime says

    void visit(OptionVisitor& visitor);
  };

  /// Throws Error(kData) for files that cannot be used, Error(kUsage) for classes that do not fit.
  SegnetSegmenter(Options options, const StageContext& context);

  ClassNames classes() const override { return classes_; }
  Segmentation segment(const Frame& frame) override;

 private:
  cv::Mat scores(const cv::Mat& bgr);

  Options options_;
  ClassNames classes_;
  SegnetNetwork network_;
};

}  // namespace stillpoint::segmenter_segnet
