#include "stillpoint/runtime/stage_results.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <opencv2/core.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "stillpoint/error.hpp"
#include "stillpoint/runtime/map_values.hpp"
#include "stillpoint/runtime/stage_requirement.hpp"
#include "stillpoint/support/size_text.hpp"

namespace stillpoint {
namespace {

constexpr double kLargestSkew = 1e-3;  // of a rotation matrix from an orthonormal one
constexpr double kSamePose = 1e-6;     // relative difference of two matrices
// The same, of products: with matrices that are as skew as they may be, and their transposes for
// their inverses.
constexpr double kSameProduct = 2 * kLargestSkew;
constexpr float kFarthestMedian = 200;  // metres; a room's is above that in millimetres

/// `what` is in the plural: "the labels".
void check_image(const cv::Mat& image, cv::Size frame, const std::string& what,
                 const std::string& remedy) {
  require_of_stage(image.type() == CV_8UC1,
                   what + " are of " + cv::typeToString(image.type()) + ", not of CV_8UC1", remedy);
  require_of_stage(
      image.size() == frame,
      what + " have " + size_text(image.size()) + " pixels, but the frame has " + size_text(frame),
      remedy);
}

void check_type(const cv::Mat& image, int type, const std::string& what) {
  require_of_stage(image.type() == type, what + " is of " + cv::typeToString(image.type()),
                   "it must be of " + cv::typeToString(type));
}

bool is_pose(const Pose& pose) {
  const Eigen::Matrix3d rotation = pose.linear();
  return pose.matrix().allFinite() && rotation.determinant() > 0 &&  // no mirror image
         (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm() < kLargestSkew;
}

/// Of a correction; `what`: "key frame" or "landmark".
void check_id(std::uint32_t id, std::size_t end, const std::string& what) {
  require_of_stage(id < end,
                   "the correction names " + what + " " +
                       (id == kNoId ? "kNoId" : std::to_string(id)) + " of " + std::to_string(end),
                   "use ids of the map that it was computed on");
}

int highest(const cv::Mat& image) {
  double value = 0;
  cv::minMaxLoc(image, nullptr, &value);
  return static_cast<int>(value);
}

std::string text_of(const cv::Point2f& position) {
  std::ostringstream text;
  text << position.x << ", " << position.y;
  return text.str();
}

std::optional<cv::Point2f> position_outside(const MovingPoints& moving, cv::Size frame) {
  const cv::Rect image({}, frame);
  for (const PointMotion& point : moving.points)
    for (const cv::Point2f& position : {point.previous, point.current})
      if (!image.contains(cv::Point(position))) return position;
  return std::nullopt;
}

/// Whether squares of one number of pixels, so many in each direction, cover a frame; what is left
/// of it at the right and below may have cells of its own or none.
bool are_cells(cv::Size cells, cv::Size frame) {
  for (int side = 1; side <= std::max(frame.width, frame.height); ++side)
    if (std::abs(cells.width * side - frame.width) < side &&
        std::abs(cells.height * side - frame.height) < side)
      return true;
  return false;
}

/// Of the pixels with a measurement, from a sample of the image; 0 without any.
float median_depth(const cv::Mat& depth) {
  constexpr int kStep = 8;  // pixels
  std::vector<float> measured;
  for (int y = 0; y < depth.rows; y += kStep)
    for (int x = 0; x < depth.cols; x += kStep)
      if (const float z = depth.at<float>(y, x); z > 0) measured.push_back(z);
  if (measured.empty()) return 0;
  const auto middle = measured.begin() + static_cast<std::ptrdiff_t>(measured.size() / 2);
  std::ranges::nth_element(measured, middle);
  return *middle;
}

void check_objects(const Segmentation& segmentation, std::size_t classes) {
  const cv::Rect image({}, segmentation.labels.size());
  for (const SegmentedObject& object : segmentation.objects) {
    require_of_stage(object.label > 0 && object.label < static_cast<int>(classes),
                     "an object has label " + std::to_string(object.label) + " of " +
                         std::to_string(classes) + " classes",
                     "labels of objects count from 1 to classes() - 1");
    require_of_stage(object.box.empty() || (object.box & image) == object.box,
                     "the box of an object is not in the image",
                     "boxes are in pixels of the frame");
  }
}

void check_keyframe(const KeyFrame& keyframe, const Frame& frame, const SparseMap& map,
                    KeyFrameId next) {
  require_of_stage(keyframe.id == next,
                   "the key frame has id " + std::to_string(keyframe.id) +
                       ", but the next one is " + std::to_string(next),
                   "take TrackHints::next_keyframe");
  require_of_stage(keyframe.frame == frame.index,
                   "the key frame is of frame " + std::to_string(keyframe.frame),
                   "KeyFrame::frame must be the index of the frame that was tracked");
  require_of_stage(keyframe.time == frame.time,
                   "the time of the key frame is not that of its frame",
                   "set KeyFrame::time to Frame::time");
  require_of_stage(keyframe.camera != nullptr, "the key frame has no camera",
                   "give it that of the frame");
  require_of_stage(possible(*keyframe.camera), "the camera of the key frame has impossible values",
                   "give it that of the frame");
  require_of_stage(keyframe.features != nullptr, "the key frame has no features",
                   "a tracker without point features gives an empty Features");
  require_of_stage(is_pose(keyframe.world_from_camera),
                   "the pose of the key frame is no rigid motion",
                   "it must be finite, with an orthonormal rotation");
  const Features& features = *keyframe.features;
  const std::size_t count = features.size();
  const auto require_count = [count](std::size_t size, const std::string& what) {
    require_of_stage(size == count,
                     "the key frame has " + std::to_string(count) + " keypoints, but " +
                         std::to_string(size) + " " + what,
                     "give one of each per keypoint");
  };
  if (!features.descriptors.empty()) require_count(features.descriptors.size(), "descriptors");
  require_count(features.depth.size(), "depths");
  require_count(keyframe.track_weights.size(), "track weights");
  require_count(keyframe.map_weights.size(), "map weights");
  require_count(keyframe.landmarks.size(), "landmarks");
  require_of_stage(
      std::ranges::all_of(keyframe.landmarks,
                          [&](LandmarkId id) { return id == kNoId || id < map.landmark_id_end(); }),
      "the key frame sees a landmark that is not in the map",
      "use ids of the map that track() was given");
  const std::string fault = fault_of(features, *keyframe.camera);
  require_of_stage(fault.empty(), "the key frame has wrong features: " + fault,
                   "positions are in pixels of the frame, octaves count from 0 to "
                   "Features::levels - 1, a depth of 0 stands for no measurement");
  require_of_stage(keyframe.covariance.allFinite(), "the covariance of the key frame is not finite",
                   "leave it 0 where it is not known");
}

/// The pose by the reference, which trajectories follow, is that of the result.
void check_reference(const TrackResult& result, const Pose& world_from_reference) {
  const Pose pose = world_from_reference * result.reference_from_camera;
  require_of_stage(pose.isApprox(result.world_from_camera, kSameProduct),
                   "reference_from_camera and world_from_camera are two different poses",
                   "world_from_camera = map.world_from_keyframe(reference) * "
                   "reference_from_camera");
}

/// Key frames and landmarks that `before` does not have, or not as they are now.
void check_changes(const SparseMap& map, const SparseMap& before) {
  for (KeyFrameId id = 0; id < map.keyframe_id_end(); ++id) {
    const KeyFrame* keyframe = map.keyframe(id);
    if (!keyframe || keyframe == before.keyframe(id) || is_pose(keyframe->world_from_camera))
      continue;
    require_of_stage(false, "the pose of key frame " + std::to_string(id) + " is no rigid motion",
                     "it must be finite, with an orthonormal rotation");
  }
  for (LandmarkId id = 0; id < map.landmark_id_end(); ++id) {
    const Landmark* landmark = map.landmark(id);
    if (!landmark || landmark == before.landmark(id) || landmark->position_in_world.allFinite())
      continue;
    require_of_stage(false, "the position of landmark " + std::to_string(id) + " is not finite",
                     "remove landmarks whose position is not known");
  }
}

}  // namespace

void check_frame(const Frame& frame, std::uint32_t index, const Frame* previous) {
  require_of_stage(frame.index == index, "the frame has index " + std::to_string(frame.index),
                   "indices count from 0 without gaps");
  require_of_stage(std::isfinite(frame.time), "the time of the frame is not finite",
                   "give the time of the colour image in seconds");
  require_of_stage(!previous || frame.time >= previous->time,
                   "the frame is " + std::to_string(previous ? previous->time - frame.time : 0) +
                       " s older than the one before",
                   "give frames in order of time");
  require_of_stage(!frame.gray.empty(), "the frame has no image",
                   "leave out images that cannot be read");
  require_of_stage(frame.bgr.size() == frame.gray.size() && frame.depth.size() == frame.gray.size(),
                   "the colour, grey and depth images of a frame differ in size",
                   "all three are needed, of the camera's size");
  check_type(frame.bgr, CV_8UC3, "the colour image");
  check_type(frame.gray, CV_8UC1, "the grey image");
  check_type(frame.depth, CV_32FC1, "the depth image");
  require_of_stage(frame.camera != nullptr, "the frame has no camera", "set Frame::camera");
  require_of_stage(frame.gray.size() == cv::Size(frame.camera->width, frame.camera->height),
                   "the images have " + size_text(frame.gray.size()) + " pixels, the camera " +
                       size_text({frame.camera->width, frame.camera->height}),
                   "give images of the camera's size");
  require_of_stage(possible(*frame.camera), "the camera of the frame has impossible values",
                   "focal lengths lie between 1 and 1e6 px, the principal point within 1e6 px, the "
                   "noise of depth between 1e-6 and 100 m");
  require_of_stage(!previous || previous->gray.size() == frame.gray.size(),
                   "the images have another size than those before",
                   "all images of a run have one size");
  if (previous) return;
  const float depth = median_depth(frame.depth);
  require_of_stage(
      depth < kFarthestMedian,
      "half of the first depth image lies beyond " +
          std::to_string(static_cast<int>(std::min(depth, 1e9F))) + " m",
      "give depth in metres; of images in other units, the camera's depth_factor says it");
}

void check_segmentation(const Segmentation& segmentation, const Frame& of, std::size_t classes) {
  if (!segmentation.known()) return;
  const cv::Size frame = of.gray.size();
  require_of_stage(segmentation.frame == of.index,
                   "Segmentation::frame is " + std::to_string(segmentation.frame) + " for frame " +
                       std::to_string(of.index),
                   "set it to Frame::index: propagators tell by it which labels are new");
  check_image(segmentation.labels, frame, "the labels", "give one byte per pixel of the frame");
  const int label = highest(segmentation.labels);
  require_of_stage(label < std::max(1, static_cast<int>(classes)),
                   "a pixel has label " + std::to_string(label) + ", but there are " +
                       std::to_string(classes) + " classes",
                   "labels count from 0, the background, to classes() - 1");
  check_objects(segmentation, classes);
  if (segmentation.instances.empty()) return;
  check_image(segmentation.instances, frame, "the instances",
              "give one byte per pixel of the frame");
  const int instance = highest(segmentation.instances);
  require_of_stage(instance <= static_cast<int>(segmentation.objects.size()),
                   "a pixel belongs to object " + std::to_string(instance) + " of " +
                       std::to_string(segmentation.objects.size()),
                   "number instances from 1, as in the list of objects");
}

void check_moving_points(const MovingPoints& moving, cv::Size frame) {
  require_of_stage(std::ranges::all_of(moving.points,
                                       [](const PointMotion& point) {
                                         return std::isfinite(point.previous.x + point.previous.y +
                                                              point.current.x + point.current.y);
                                       }),
                   "a point is not finite", "leave out points that were not found again");
  require_of_stage(!moving.camera_motion || is_pose(*moving.camera_motion),
                   "the camera's motion is no rigid motion",
                   "leave camera_motion empty where it was not found");
  if (const auto outside = position_outside(moving, frame))
    require_of_stage(false, "a point at " + text_of(*outside) + " is not in the image",
                     "points are in pixels of the frame; leave out those that left it");
}

void check_evidence(const MapEvidence& evidence, cv::Size frame) {
  if (evidence.log_odds.empty()) return;
  check_type(evidence.log_odds, CV_32FC1, "the evidence");
  require_of_stage(are_cells(evidence.log_odds.size(), frame),
                   "the evidence has " + size_text(evidence.log_odds.size()) +
                       " cells, which do not cover the frame of " + size_text(frame) +
                       " pixels as squares",
                   "give one value per square of n x n pixels, from the upper left corner on");
}

void check_weights(const StaticWeights& weights, const Segmentation& segmentation, cv::Size frame) {
  for (const cv::Mat* image : {&weights.track, &weights.map})
    if (!image->empty())
      check_image(*image, frame, "the weights",
                  "give one byte per pixel of the frame, or an empty image");
  require_of_stage(
      weights.object_moves.empty() || weights.object_moves.size() == segmentation.objects.size(),
      std::to_string(weights.object_moves.size()) + " objects are judged, but there are " +
          std::to_string(segmentation.objects.size()),
      "object_moves has one entry per object of the labels, or none");
}

void check_prepared(const PreparedFrame* prepared, const Frame& frame) {
  require_of_stage(prepared != nullptr, "prepare() gave nothing",
                   "give a PreparedFrame with the frame, of your own type or not");
  require_of_stage(prepared->frame.get() == &frame, "prepare() gave another frame",
                   "make it with the frame that prepare() was given");
}

void check_tracking(const TrackResult& result, const Frame& frame, const SparseMap& map,
                    const TrackHints& hints) {
  if (result.keyframe) {
    require_of_stage(!hints.localise_only, "it made a key frame, but the map stays as it is",
                     "make none with TrackHints::localise_only");
    require_of_stage(result.state == TrackState::kTracking,
                     "it made a key frame, but is " + std::string(name_of(result.state)),
                     "a key frame needs a pose: make it with kTracking only");
    check_keyframe(*result.keyframe, frame, map, hints.next_keyframe);
  }
  if (result.state != TrackState::kTracking) return;
  require_of_stage(
      is_pose(result.world_from_camera) && is_pose(result.reference_from_camera),
      "the pose is no rigid motion",
      "it must be finite, with an orthonormal rotation; return kLost where there is none");
  require_of_stage(
      !result.keyframe ||
          result.keyframe->world_from_camera.isApprox(result.world_from_camera, kSamePose),
      "the key frame has another pose than its frame", "world_from_camera is the same in both");
  const KeyFrameId end = hints.next_keyframe + (result.keyframe ? 1 : 0);
  require_of_stage(result.reference < end,
                   "the reference is key frame " +
                       (result.reference == kNoId ? "kNoId" : std::to_string(result.reference)) +
                       " of " + std::to_string(end),
                   "TrackResult::reference must be a key frame of the map, or the one just made");
  if (result.reference < map.keyframe_id_end())
    check_reference(result, map.world_from_keyframe(result.reference));
  else if (result.reference == hints.next_keyframe)
    check_reference(result, result.keyframe->world_from_camera);
}

void check_inserted(const SparseMap& map, const SparseMap& before) {
  const std::size_t end = before.keyframe_id_end();
  require_of_stage(map.keyframe_id_end() == end + 1 && map.keyframe(static_cast<KeyFrameId>(end)),
                   "key frame " + std::to_string(end) + " was not added to the map",
                   "insert() adds it, under its own id; refine() may remove it");
  check_refined(map, before);
}

void check_refined(const SparseMap& map, const SparseMap& before) {
  require_of_stage(map.keyframe_id_end() >= before.keyframe_id_end() &&
                       map.landmark_id_end() >= before.landmark_id_end(),
                   "ids of the map are gone", "give the next version of the map it was given");
  check_changes(map, before);
}

void check_correction(const MapCorrection& correction, const SparseMap& map) {
  require_of_stage(correction.keyframe_id_end <= map.keyframe_id_end(),
                   "the correction is of a map with more key frames",
                   "keyframe_id_end is that of the map it was computed on");
  for (const MovedKeyFrame& moved : correction.moved) {
    check_id(moved.keyframe, map.keyframe_id_end(), "key frame");
    require_of_stage(moved.keyframe < correction.keyframe_id_end,
                     "the correction is of a map with " +
                         std::to_string(correction.keyframe_id_end) +
                         " key frames, but moves key frame " + std::to_string(moved.keyframe),
                     "set keyframe_id_end to that of the map it was computed on");
    require_of_stage(
        is_pose(moved.world_from_camera),
        "the new pose of key frame " + std::to_string(moved.keyframe) + " is no rigid motion",
        "it must be finite, with an orthonormal rotation");
  }
  for (const auto& [landmark, position] : correction.landmarks) {
    check_id(landmark, map.landmark_id_end(), "landmark");
    require_of_stage(position.allFinite(),
                     "the new position of landmark " + std::to_string(landmark) + " is not finite",
                     "leave out landmarks that were not optimised: they move with their key frame");
  }
  for (const auto& [kept, gone] : correction.fused) {
    check_id(kept, map.landmark_id_end(), "landmark");
    check_id(gone, map.landmark_id_end(), "landmark");
  }
}

}  // namespace stillpoint
