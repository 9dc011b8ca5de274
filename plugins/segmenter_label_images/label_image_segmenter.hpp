// Labels that were made elsewhere: the truth of a simulated recording, or a network run before.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "segmenter_label_images/adversarial_labels.hpp"
#include "segmenter_label_images/label_files.hpp"
#include "segmenter_label_images/network_errors.hpp"
#include "stillpoint/sdk.hpp"

namespace stillpoint::segmenter_label_images {

/// A frame without an image has no labels; when none of the first ten frames has one, the folder
/// belongs to another recording and segment() throws Error(kData).
class LabelImageSegmenter final : public Segmenter {
 public:
  struct Options {
    std::string path;                              ///< folder; empty: `labels` in the recording
    std::vector<std::string> classes = {"voc21"};  ///< one: the name of a list
    double max_difference = 0.001;  ///< seconds between an image's stamp and the frame's
    int min_object_pixels = 100;    ///< smaller objects become background
    NetworkErrorOptions errors;
    AdversarialOptions adversarial;

    void visit(OptionVisitor& visitor);
  };

  LabelImageSegmenter(Options options, const StageContext& context);

  ClassNames classes() const override { return classes_; }
  Segmentation segment(const Frame& frame) override;

 private:
  const LabelFiles::Entry* entry_for(const Frame& frame);
  void report_missing(const Frame& frame, const LabelFiles::Entry& nearest);

  Options options_;
  ClassNames classes_;
  LabelFiles files_;
  NetworkErrors errors_;
  AdversarialLabels adversarial_;
  std::function<void(LogLevel, std::string_view)> log_;
  std::size_t found_ = 0;    // frames with labels so far
  std::size_t missing_ = 0;  // and without
};

}  // namespace stillpoint::segmenter_label_images
