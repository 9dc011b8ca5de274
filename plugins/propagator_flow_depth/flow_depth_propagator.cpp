#include "propagator_flow_depth/flow_depth_propagator.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "propagator_flow_depth/mask_fit.hpp"
#include "propagator_flow_depth/mask_rim.hpp"
#include "propagator_flow_depth/mask_warp.hpp"
#include "propagator_flow_depth/object_matching.hpp"
#include "stillpoint/support/objects.hpp"
#include "stillpoint/support/pixel_scale.hpp"

namespace stillpoint::propagator_flow_depth {
namespace {

constexpr std::size_t kHistory = 16;     // views
constexpr int kMaxPoints = 120;          // of all objects together
constexpr int kMinPoints = 10;           // of each
constexpr double kMinSupport = 0.25;     // share of measurements in the layer
constexpr double kMinMissedShare = 0.2;  // of an object, for the missed part to become an object
constexpr double kTrackReach = 12.0;     // px of a view, around a track, that move with it

cv::Rect grown(cv::Rect box, int by, cv::Size image) {
  return cv::Rect(box.x - by, box.y - by, box.width + 2 * by, box.height + 2 * by) &
         cv::Rect({}, image);
}

/// The frame's pixels of a view's box.
cv::Rect frame_box(cv::Rect box, cv::Size frame) {
  return grown(
      {box.x * kViewScale, box.y * kViewScale, box.width * kViewScale, box.height * kViewScale},
      kViewScale, frame);
}

/// Where the tracked points say that the object is now, with room for its outline to move.
cv::Rect search_region(const FollowedObject& object, int margin, cv::Size image) {
  cv::Rect2f box = object.reference_box;
  cv::Point2f least = median_motion(object.tracks).shift;
  cv::Point2f most = least;
  for (const Track& track : object.tracks) {
    if (track.lost) continue;
    const cv::Point2f shift = track.current - track.reference;
    least = {std::min(least.x, shift.x), std::min(least.y, shift.y)};
    most = {std::max(most.x, shift.x), std::max(most.y, shift.y)};
  }
  const cv::Rect2f reached(box.tl() + least, box.br() + most);
  return grown(reached, 3 * margin, image);
}

}  // namespace

void FlowDepthPropagator::Options::visit(OptionVisitor& v) {
  v("points", points,
    {.min = kMinPoints,
     .max = 500,
     .help = "corners followed on each object by optical flow; more: steadier, slower"});
  v("max_flow_error", max_flow_error,
    {.min = 0.05,
     .max = 20,
     .unit = "px",
     .help = "forward-backward error above which a point is dropped"});
  v("min_points", min_points,
    {.min = 0,
     .help = "points that must still be followed on an object for its mask to be kept while the "
             "network misses it"});
  v("keep_seconds", keep_seconds,
    {.min = 0,
     .max = 60,
     .unit = "s",
     .help = "time for which the mask of an object is kept that the network misses"});
  v("max_misses", max_misses,
    {.min = 0,
     .help = "results of the network in a row that may miss an object before its mask is dropped"});
  v("margin", margin,
    {.min = 2,
     .max = 40,
     .unit = "px",
     .help = "distance within which the outline of a mask is moved to a depth edge"});
  v("depth_tolerance", depth_tolerance,
    {.min = 0.01,
     .max = 2,
     .unit = "m",
     .help = "depth difference from which pixels 2 m away lie on different surfaces; larger: masks "
             "take in what is behind"});
  v("min_object_pixels", min_object_pixels,
    {.min = 1, .unit = "px", .help = "smaller objects become background"});
}

Segmentation FlowDepthPropagator::propagate(const Segmentation& segmentation, const Frame& from,
                                            const Frame& to) {
  View view = make_view(to, spare_view());
  if (!history_.empty() && history_.back().size() != view.size()) {
    history_.clear();
    objects_.clear();
  }
  history_.push_back(std::move(view));
  if (segmentation.frame != segmented_frame_) {
    segmented_frame_ = segmentation.frame;
    has_labels_ |= segmentation.known();
    if (segmentation.known()) associate(segmentation, view_of(from));
  }
  propagate_tracks();
  View& now = history_.back();
  for (FollowedObject& object : objects_) predict_mask(object, now);
  std::erase_if(objects_, [&](const FollowedObject& object) { return !supported(object, now); });
  compose_instances(now);
  for (FollowedObject& object : objects_) renew_reference(object, now);
  return result(now, to);
}

int FlowDepthPropagator::rim() const { return std::max(1, options_.margin / kViewScale); }

View FlowDepthPropagator::spare_view() {
  View spare;
  while (history_.size() >= kHistory) {
    spare = std::move(history_.front());
    history_.pop_front();
  }
  return spare;
}

const View& FlowDepthPropagator::view_of(const Frame& frame) {
  const auto place = std::ranges::lower_bound(history_, frame.index, {}, &View::frame);
  if (place != history_.end() && place->frame == frame.index) return *place;
  return *history_.insert(place, make_view(frame));
}

/// The view itself, or when nothing has been placed in it, the one before it; of a view that is
/// older than all others, the one after it.
const View& FlowDepthPropagator::followed_near(const View& view) const {
  const auto place = std::ranges::lower_bound(history_, view.frame, {}, &View::frame);
  if (!place->instances.empty()) return *place;
  if (place != history_.begin()) return *(place - 1);
  return place + 1 != history_.end() && !(place + 1)->instances.empty() ? *(place + 1) : *place;
}

void FlowDepthPropagator::associate(const Segmentation& segmentation, const View& view) {
  const FoundObjects found =
      found_objects(segmentation, view, {.min_pixels = options_.min_object_pixels, .rim = rim()});
  int all_pixels = 0;
  for (const FoundObject& object : found.objects) all_pixels += object.pixels;
  const View& before = followed_near(view);
  const Matches matches =
      match_objects({found.objects, found.instances, objects_, before.instances, before.ids});

  std::vector<FollowedObject> next;
  std::vector<bool> detected(objects_.size(), false);
  for (std::size_t i = 0; i < found.objects.size(); ++i) {
    const FoundObject& detection = found.objects[i];
    const int known = matches.followed_of[i];
    if (detection.pixels == 0) continue;
    FollowedObject object;
    if (known >= 0) {
      const auto f = static_cast<std::size_t>(known);
      if (auto rest = missed_part(objects_[f], before, found.instances, view))
        next.push_back(std::move(*rest));
      object = std::move(objects_[f]);
      detected[f] = true;
    } else {
      object.id = next_id_++;
      object.label = detection.label;
    }
    update_detected(object, detection, static_cast<double>(detection.pixels) / all_pixels, view);
    next.push_back(std::move(object));
  }
  for (std::size_t f = 0; f < objects_.size(); ++f) {
    if (detected[f] || matches.covered[f]) continue;
    update_missed(objects_[f], before);
    next.push_back(std::move(objects_[f]));
  }
  objects_ = std::move(next);
}

void FlowDepthPropagator::update_detected(FollowedObject& object, const FoundObject& detection,
                                          double share, const View& view) const {
  object.score = detection.score;
  object.detected_frame = view.frame;
  object.detected_time = view.time;
  ++object.detections;
  object.misses = 0;
  // Large objects get more points, because they occlude more.
  object.points = std::clamp(static_cast<int>(kMaxPoints * share), kMinPoints, options_.points);
  set_reference(object, detection.mask, detection.box, view);
}

/// Objects out of view do not count as missed.
void FlowDepthPropagator::update_missed(FollowedObject& object, const View& view) const {
  if (std::ranges::find(view.ids, object.id) != view.ids.end()) ++object.misses;
}

/// The part of the object that the network no longer finds, if it is wider than the uncertainty of
/// outlines: a person close to the camera of whom only an arm is recognised.
std::optional<FollowedObject> FlowDepthPropagator::missed_part(const FollowedObject& object,
                                                               const View& before,
                                                               const cv::Mat& found,
                                                               const View& view) {
  const auto place = std::ranges::find(before.ids, object.id);
  if (place == before.ids.end()) return std::nullopt;
  const cv::Mat carried = before.instances == static_cast<int>(place - before.ids.begin()) + 1;
  cv::Mat rest = carried & (found == 0);
  const double enough = kMinMissedShare * cv::countNonZero(carried);
  if (cv::countNonZero(rest) < enough) return std::nullopt;
  rest = remove_rims(rest, rim());
  if (cv::countNonZero(rest) < enough) return std::nullopt;
  FollowedObject part = object;
  part.id = next_id_++;
  ++part.misses;
  const cv::Rect box = grown(cv::boundingRect(rest), 1, view.size());
  set_reference(part, rest(box).clone(), box, view);
  return part;
}

void FlowDepthPropagator::set_reference(FollowedObject& object, const cv::Mat& mask, cv::Rect box,
                                        const View& view) const {
  object.reference_mask = mask;
  object.reference_box = box;
  object.reference_layer = depth_layer(view.depth(box), mask);
  object.tracks = choose_points(view, mask, box, object.points);
  std::erase_if(object.tracks, [&](const Track& track) {
    return track.reference_depth > 0 && object.reference_layer.known() &&
           !object.reference_layer.contains(track.reference_depth);
  });
  object.first_tracks = object.tracks.size();
  object.tracked_frame = view.frame;
}

void FlowDepthPropagator::propagate_tracks() {
  for (std::size_t i = 1; i < history_.size(); ++i) {
    std::vector<Track*> tracks;
    for (FollowedObject& object : objects_) {
      if (object.tracked_frame != history_[i - 1].frame) continue;
      object.tracked_frame = history_[i].frame;
      for (Track& track : object.tracks) tracks.push_back(&track);
    }
    follow(history_[i - 1], history_[i], tracks,
           static_cast<float>(options_.max_flow_error / kViewScale));
  }
  for (FollowedObject& object : objects_) std::erase_if(object.tracks, &Track::lost);
}

void FlowDepthPropagator::predict_mask(FollowedObject& object, const View& view) const {
  object.box = search_region(object, rim(), view.size());
  if (object.box.empty()) {
    object.mask.release();
    return;
  }
  const auto reach = static_cast<float>(kTrackReach * pixel_scale(view.size() * kViewScale));
  const cv::Mat predicted =
      warp_mask(object.reference_mask, object.reference_box, object.tracks, object.box, reach);
  object.layer = object.reference_layer.moved_by(median_motion(object.tracks).depth);
  const cv::Mat depth = view.depth(object.box);
  object.mask = fit_to_depth(predicted, depth, object.layer,
                             {.margin = rim(), .tolerance = options_.depth_tolerance});
  const int measured = cv::countNonZero(predicted & (depth > 0));
  const int kept = cv::countNonZero(object.mask & predicted & (depth > 0));
  object.support = measured > 0 ? static_cast<double>(kept) / measured : 1.0;
}

bool FlowDepthPropagator::supported(const FollowedObject& object, const View& view) const {
  const bool recent = view.time - object.detected_time <= options_.keep_seconds;
  if (object.detected_frame == segmented_frame_) {
    if (recent) return true;  // else the network is slow: flow and depth must confirm it
  } else if (!recent || object.misses > std::min(object.detections, options_.max_misses)) {
    return false;
  }
  return object.tracks.size() >= static_cast<std::size_t>(options_.min_points) &&
         object.support >= kMinSupport && !object.mask.empty() &&
         cv::countNonZero(object.mask) * kViewScale * kViewScale >= options_.min_object_pixels;
}

void FlowDepthPropagator::renew_reference(FollowedObject& object, const View& view) const {
  const bool most_lost = 3 * object.tracks.size() < object.first_tracks;
  if (!most_lost || object.mask.empty()) return;
  if (cv::countNonZero(object.mask) == 0) return;
  set_reference(object, object.mask, object.box, view);
}

/// Where two masks overlap, the nearer object occludes the other.
void FlowDepthPropagator::compose_instances(View& view) {
  std::ranges::stable_sort(objects_, {}, [](const FollowedObject& object) {
    return object.layer.known() ? object.layer.middle : 1e9f;
  });
  view.instances = cv::Mat(view.size(), CV_8UC1, cv::Scalar(0));
  view.ids.clear();
  for (FollowedObject& object : objects_) {
    if (object.mask.empty() || view.ids.size() == kMostObjects) continue;
    cv::Mat place = view.instances(object.box);
    object.mask &= place == 0;
    if (cv::countNonZero(object.mask) * kViewScale * kViewScale < options_.min_object_pixels)
      continue;
    view.ids.push_back(object.id);
    place.setTo(static_cast<int>(view.ids.size()), object.mask);
  }
}

Segmentation FlowDepthPropagator::result(const View& view, const Frame& frame) const {
  Segmentation result{.frame = frame.index};
  if (!has_labels_) return result;
  cv::resize(view.instances, result.instances, frame.gray.size(), 0, 0, cv::INTER_NEAREST);
  cv::Mat labels(1, 256, CV_8UC1, cv::Scalar(0));
  for (std::size_t i = 0; i < view.ids.size(); ++i) {
    const auto& object = *std::ranges::find(objects_, view.ids[i], &FollowedObject::id);
    const int instance = static_cast<int>(i) + 1;
    labels.at<unsigned char>(instance) = static_cast<unsigned char>(object.label);
    const cv::Rect region = frame_box(object.box, frame.gray.size());
    const cv::Mat mask = result.instances(region) == instance;
    result.objects.push_back({.id = object.id,
                              .label = object.label,
                              .box = cv::boundingRect(mask) + region.tl(),
                              .pixels = cv::countNonZero(mask),
                              .score = object.score});
  }
  cv::LUT(result.instances, labels, result.labels);
  return result;
}

}  // namespace stillpoint::propagator_flow_depth
