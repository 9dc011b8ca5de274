#include "segmenter_label_images/label_image_segmenter.hpp"

#include <cmath>
#include <sstream>
#include "stillpoint/support/objects.hpp"
#include "stillpoint/support/size_text.hpp"

namespace stillpoint::segmenter_label_images {
namespace {

constexpr std::size_t kMaxMissingAtStart = 10;  // frames without labels before the first with some

std::filesystem::path label_folder(const std::string& path, const StageContext& context) {
  if (!path.empty()) return path;
  if (!context.recording.empty()) return context.recording / "labels";
  throw Error(Fault::kUsage, "no folder of label images is given", "",
              "name it as 'path' of the segmenter");
}

/// Looked up only where it is used: a class list may lack the default.
int false_label(const LabelImageSegmenter::Options& options, const ClassNames& classes) {
  using Kind = AdversarialOptions::Kind;
  const bool wanted = options.errors.false_objects > 0 || !options.adversarial.mistaken.empty() ||
                      options.adversarial.adversarial == Kind::kEverything ||
                      options.adversarial.adversarial == Kind::kBlobs;
  return wanted ? class_id(classes, options.errors.false_class) : 0;
}

void check_size(const cv::Mat& labels, cv::Size frame, const std::filesystem::path& file) {
  if (labels.size() == frame) return;
  throw Error(Fault::kData,
              "the label image has " + size_text(labels.size()) + " pixels, but the frame has " +
                  size_text(frame),
              file.string(), "labels must belong to the undistorted and cropped images");
}

}  // namespace

void LabelImageSegmenter::Options::visit(OptionVisitor& v) {
  v("path", path,
    {.help = "folder of the label images; empty: the folder labels of the recording",
     .is_path = true});
  v("classes", classes,
    {.help = "names by class id, the background first; or one of the lists [voc21], [coco80], "
             "[person]"});
  v("max_difference", max_difference,
    {.min = 0, .max = 10, .unit = "s", .help = "largest time difference of frame and labels"});
  v("min_object_pixels", min_object_pixels,
    {.min = 1, .unit = "px", .help = "smaller objects become background"});
  errors.visit(v);
  adversarial.visit(v);
}

LabelImageSegmenter::LabelImageSegmenter(Options options, const StageContext& context)
    : options_(std::move(options)),
      classes_(classes_of(options_.classes)),
      files_(label_folder(options_.path, context)),
      errors_(options_.errors, false_label(options_, classes_), context.seed),
      adversarial_(options_.adversarial, classes_, false_label(options_, classes_), context.seed),
      log_(context.log) {
  // A wrong folder is reported before the run begins.
  const std::filesystem::path& first = files_.entries().front().file;
  const cv::Mat labels = read_labels(first, classes_.size());
  if (!context.camera) return;
  const Camera camera = context.camera->undistorted();
  check_size(labels, {camera.width, camera.height}, first);
}

Segmentation LabelImageSegmenter::segment(const Frame& frame) {
  Segmentation result{.frame = frame.index};
  const LabelFiles::Entry* entry = entry_for(frame);
  if (!entry) return result;
  cv::Mat labels = read_labels(entry->file, classes_.size());
  check_size(labels, frame.gray.size(), entry->file);
  if (adversarial_.any()) labels = adversarial_.apply(labels, errors_.period_of(frame.index));
  result.labels =
      errors_.any() ? errors_.apply(labels, frame.index, options_.min_object_pixels) : labels;
  find_objects(result, options_.min_object_pixels);
  return result;
}

/// Null: there is none. With `late`, the first labels serve until the delay has passed.
const LabelFiles::Entry* LabelImageSegmenter::entry_for(const Frame& frame) {
  const LabelFiles::Entry& own = files_.nearest(frame.time);
  if (std::abs(own.time - frame.time) > options_.max_difference) {
    report_missing(frame, own);
    return nullptr;
  }
  ++found_;
  return options_.adversarial.late > 0 ? &files_.nearest(frame.time - options_.adversarial.late)
                                       : &own;
}

void LabelImageSegmenter::report_missing(const Frame& frame, const LabelFiles::Entry& nearest) {
  std::ostringstream text;
  text.precision(6);
  text << std::fixed << "the frame at " << frame.time << " s has no label image; the nearest, "
       << nearest.file.filename().string() << ", is " << std::abs(nearest.time - frame.time)
       << " s away";
  if (++missing_ >= kMaxMissingAtStart && found_ == 0)
    throw Error(Fault::kData, text.str() + ", and none of the first frames has one",
                nearest.file.parent_path().string(), "are these the labels of this recording?");
  if (missing_ == 1) log_(LogLevel::kWarning, text.str());
}

}  // namespace stillpoint::segmenter_label_images
