#include "segmenter_label_images/network_errors.hpp"

#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "segmenter_label_images/frame_random.hpp"
#include "stillpoint/support/objects.hpp"

namespace stillpoint::segmenter_label_images {
namespace {

/// px along an outline over which its error stays about the same.
constexpr int kErrorCell = 16;

/// The object (CV_8UC1) with its outline moved outwards by `shift` (px; CV_32F of the same size).
/// There must be room for it around the object.
cv::Mat moved_outline(const cv::Mat& object, const cv::Mat& shift) {
  // Distances reach from pixel centre to pixel centre; the outline is half a pixel off either.
  cv::Mat inside, outside;
  cv::distanceTransform(object, inside, cv::DIST_L2, cv::DIST_MASK_5);
  cv::distanceTransform(object == 0, outside, cv::DIST_L2, cv::DIST_MASK_5);
  cv::Mat signed_distance = inside - outside;
  signed_distance += shift;
  cv::add(signed_distance, -0.5, signed_distance, object);
  cv::add(signed_distance, 0.5, signed_distance, object == 0);
  return signed_distance > 0;
}

}  // namespace

void NetworkErrorOptions::visit(OptionVisitor& v) {
  v("miss_rate", miss_rate, {.min = 0, .max = 1, .help = "probability that an object is missed"});
  v("boundary", boundary,
    {.min = -100,
     .max = 100,
     .unit = "px",
     .help = "imitated error: masks are dilated by this much; < 0: eroded"});
  v("outline_error", outline_error,
    {.min = 0,
     .max = 100,
     .unit = "px",
     .help = "imitated error: outlines are off by up to this much, at random"});
  v("missing_lower_part", missing_lower_part,
    {.min = 0,
     .max = 1,
     .help =
         "imitated error: share of each object's height that its mask misses at the lower end"});
  v("holes", holes,
    {.min = 0,
     .max = 1000,
     .help = "imitated error: holes in each mask, each a seventh as wide as it"});
  v("floor", floor,
    {.min = 0,
     .max = 10,
     .help = "width of the floor that is labelled as the object standing on it, relative to the "
             "object's; 0: none"});
  v("false_objects", false_objects,
    {.min = 0, .max = 1, .help = "probability that a frame has an object that is not there"});
  v("false_class", false_class, {.help = "class of the objects that are not there"});
  v("error_frames", error_frames,
    {.min = 1, .unit = "frames", .help = "frames that a miss, a false object or a blob lasts"});
}

cv::Mat NetworkErrors::apply(const cv::Mat& labels, std::uint32_t frame,
                             int min_object_pixels) const {
  Segmentation truth{.labels = labels};
  find_objects(truth, min_object_pixels);
  const std::uint32_t period = period_of(frame);
  cv::RNG misses = frame_random(seed_, Purpose::kMisses, period);
  const bool shifts_outlines = options_.boundary != 0 || options_.outline_error > 0;
  const cv::Mat shift = shifts_outlines ? outline_shift(labels.size(), frame) : cv::Mat();
  cv::RNG holes = frame_random(seed_, Purpose::kHoles, frame);
  const int room =
      static_cast<int>(std::ceil(std::abs(options_.boundary) + options_.outline_error)) + 2;

  cv::Mat result(labels.size(), CV_8UC1, cv::Scalar(0));
  const cv::Rect image({}, labels.size());
  for (std::size_t i = 0; i < truth.objects.size(); ++i) {
    if (misses.uniform(0.0, 1.0) < options_.miss_rate) continue;
    const SegmentedObject& object = truth.objects[i];
    const cv::Rect box = object.box;
    const int side = room + cvCeil(box.width * std::max(0.0, options_.floor - 1) / 2);
    const cv::Rect region =
        cv::Rect(box.x - side, box.y - room, box.width + 2 * side, box.height + 2 * room) & image;
    cv::Mat mask = truth.instances(region) == static_cast<int>(i) + 1;
    if (shifts_outlines) mask = moved_outline(mask, shift(region));
    degrade(mask, box - region.tl(), holes);
    result(region).setTo(object.label, mask & (result(region) == 0));
  }
  add_false_object(result, period);
  return result;
}

void NetworkErrors::degrade(cv::Mat& mask, const cv::Rect& box, cv::RNG& random) const {
  const int missing = cvRound(options_.missing_lower_part * box.height);
  if (missing > 0) mask.rowRange(box.br().y - missing, mask.rows).setTo(0);
  for (int i = 0; i < options_.holes; ++i) {
    const cv::Point centre(random.uniform(box.x, box.br().x), random.uniform(box.y, box.br().y));
    cv::circle(mask, centre, std::max(1, box.width / 14), 0, cv::FILLED);
  }
  const cv::Size floor(cvRound(options_.floor * box.width), box.height / 8);
  const cv::Point at(box.x + (box.width - floor.width) / 2, box.br().y - floor.height);
  mask(cv::Rect(at, floor) & cv::Rect({}, mask.size())).setTo(255);
}

cv::Mat NetworkErrors::outline_shift(cv::Size size, std::uint32_t frame) const {
  if (options_.outline_error == 0) return {size, CV_32F, cv::Scalar(options_.boundary)};
  cv::Mat coarse(size.height / kErrorCell + 2, size.width / kErrorCell + 2, CV_32F);
  cv::RNG random = frame_random(seed_, Purpose::kOutlines, frame);
  random.fill(coarse, cv::RNG::UNIFORM, options_.boundary - options_.outline_error,
              options_.boundary + options_.outline_error);
  cv::Mat shift;
  cv::resize(coarse, shift, size, 0, 0, cv::INTER_LINEAR);
  return shift;
}

void NetworkErrors::add_false_object(cv::Mat& labels, std::uint32_t period) const {
  cv::RNG random = frame_random(seed_, Purpose::kFalseObjects, period);
  if (random.uniform(0.0, 1.0) >= options_.false_objects) return;
  labels.setTo(false_label_, random_blob(labels.size(), random) & (labels == 0));
}

}  // namespace stillpoint::segmenter_label_images
