#include "segmenter_label_images/adversarial_labels.hpp"

#include <opencv2/core.hpp>

#include "segmenter_label_images/frame_random.hpp"

namespace stillpoint::segmenter_label_images {
namespace {

constexpr int kBlobs = 6;  // they cover about a third of the image

}  // namespace

void AdversarialOptions::visit(OptionVisitor& v) {
  v.choice("adversarial", adversarial,
           {{"none", Kind::kNone},
            {"everything", Kind::kEverything},
            {"nobody", Kind::kNobody},
            {"blobs", Kind::kBlobs}},
           {.help = "instead of the labels: the false class everywhere, nowhere, or in random "
                    "ellipses"});
  v("mistaken", mistaken, {.help = "classes whose objects are labelled as false_class"});
  v("late", late,
    {.min = 0,
     .max = 60,
     .unit = "s",
     .help = "imitated delay of a network: labels are those of an image this much older"});
}

AdversarialLabels::AdversarialLabels(const AdversarialOptions& options, const ClassNames& classes,
                                     int false_label, std::uint64_t seed)
    : kind_(options.adversarial), false_label_(false_label), seed_(seed) {
  for (const std::string& name : options.mistaken) mistaken_.push_back(class_id(classes, name));
}

cv::Mat AdversarialLabels::apply(const cv::Mat& labels, std::uint32_t period) const {
  using Kind = AdversarialOptions::Kind;
  if (kind_ == Kind::kEverything) return {labels.size(), CV_8UC1, cv::Scalar(false_label_)};
  cv::Mat result = kind_ == Kind::kNone ? labels.clone() : cv::Mat::zeros(labels.size(), CV_8UC1);
  if (kind_ == Kind::kBlobs) {
    cv::RNG random = frame_random(seed_, Purpose::kBlobs, period);
    for (int i = 0; i < kBlobs; ++i) result.setTo(false_label_, random_blob(labels.size(), random));
  }
  if (kind_ == Kind::kNone)
    for (const int label : mistaken_) result.setTo(false_label_, labels == label);
  return result;
}

}  // namespace stillpoint::segmenter_label_images
