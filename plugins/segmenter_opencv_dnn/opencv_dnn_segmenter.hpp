// Labels from any network that OpenCV reads (paper III-B).
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "segmenter_opencv_dnn/box_mask.hpp"
#include "segmenter_opencv_dnn/class_scores.hpp"
#include "segmenter_opencv_dnn/detections.hpp"
#include "segmenter_opencv_dnn/guided_filter.hpp"
#include "segmenter_opencv_dnn/network.hpp"
#include "segmenter_opencv_dnn/small_objects.hpp"
#include "stillpoint/sdk.hpp"

namespace stillpoint::segmenter_opencv_dnn {

/// The defaults are those of the small person network that comes with the plugin.
class OpenCvDnnSegmenter final : public Segmenter {
 public:
  struct Options {
    NetworkOptions network;
    ScoreRule rule;
    CellAlignment cells = CellAlignment::kCentres;
    std::vector<std::string> classes = {"person"};  ///< one: the name of a list
    RefinementOptions refinement;
    BoxMaskOptions boxes;
    SmallestObject smallest;
    bool mirror = false;  ///< every second image: errors often differ in the mirrored one
    int threads = 0;      ///< of OpenCV, in the whole process; 0: as many as the runtime allows

    void visit(OptionVisitor& visitor);
  };

  /// Throws Error for files, options and outputs that do not belong together.
  OpenCvDnnSegmenter(const Options& options, const StageContext& context);

  ClassNames classes() const override { return classes_; }
  Segmentation segment(const Frame& frame) override;

 private:
  Segmentation segment_as_is(const Frame& frame);
  void check_outputs() const;
  void check_boxes(const cv::Mat& output) const;
  void check_planes(const cv::Mat& output) const;
  [[noreturn]] void refuse(const cv::Mat& output, const std::string& expected) const;
  Segmentation from_scores(const cv::Mat& output, const Frame& frame);
  Segmentation from_boxes(std::vector<Detection> found, const Frame& frame) const;
  void warn_of_darkness(const Frame& frame);

  Options options_;
  ClassNames classes_;
  Network network_;
  CellGrid grid_;        // for the image size seen last
  unsigned images_ = 0;  // seen so far
  std::function<void(LogLevel, std::string_view)> log_;
  bool has_warned_ = false;  // that images are dark
};

}  // namespace stillpoint::segmenter_opencv_dnn
