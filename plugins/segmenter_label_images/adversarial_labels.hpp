// Adversarial labels, for robustness tests: far more wrong than those of a network.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "stillpoint/class_names.hpp"
#include "stillpoint/options.hpp"

namespace stillpoint::segmenter_label_images {

struct AdversarialOptions {
  enum class Kind { kNone, kEverything, kNobody, kBlobs } adversarial = Kind::kNone;
  std::vector<std::string> mistaken;  ///< classes whose objects get the false class
  double late = 0;                    ///< seconds

  void visit(OptionVisitor& visitor);
};

/// They depend on the seed and on the frame alone.
class AdversarialLabels {
 public:
  /// `false_label`: replaces labels. Throws Error(kUsage) when `mistaken` has no such class.
  AdversarialLabels(const AdversarialOptions& options, const ClassNames& classes, int false_label,
                    std::uint64_t seed);

  bool any() const { return kind_ != AdversarialOptions::Kind::kNone || !mistaken_.empty(); }
  /// `period`: frames with the same number have the same blobs.
  cv::Mat apply(const cv::Mat& labels, std::uint32_t period) const;

 private:
  AdversarialOptions::Kind kind_;
  std::vector<int> mistaken_;
  int false_label_;
  std::uint64_t seed_;
};

}  // namespace stillpoint::segmenter_label_images
