#include "stillpoint/runtime/stage_results.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <string>

#include "stillpoint/error.hpp"
#include "stillpoint/support/size_text.hpp"

namespace stillpoint {
namespace {

constexpr double kLargestSkew = 1e-3;  // of a rotation matrix from an orthonormal one

void require(bool right, const std::string& problem, const std::string& remedy) {
  if (!right) throw Error(Fault::kStage, problem, "", remedy);
}

/// `what` is in the plural: "the labels".
void check_image(const cv::Mat& image, int type, cv::Size frame, const std::string& what,
                 const std::string& remedy) {
  if (image.type() == type && image.size() == frame) return;
  const std::string other = image.type() == type ? "" : " of " + cv::typeToString(image.type());
  throw Error(Fault::kStage,
              what + " have " + size_text(image.size()) + " pixels" + other +
                  ", but the frame has " + size_text(frame),
              "", remedy);
}

void check_type(const cv::Mat& image, int type, const std::string& what) {
  require(image.type() == type, what + " is of " + cv::typeToString(image.type()),
          "it must be of " + cv::typeToString(type));
}

bool is_pose(const Pose& pose) {
  const Eigen::Matrix3d rotation = pose.linear();
  return pose.matrix().allFinite() &&
         (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm() < kLargestSkew;
}

int highest(const cv::Mat& image) {
  double value = 0;
  cv::minMaxLoc(image, nullptr, &value);
  return static_cast<int>(value);
}

void check_objects(const Segmentation& segmentation, std::size_t classes) {
  const cv::Rect image({}, segmentation.labels.size());
  for (const SegmentedObject& object : segmentation.objects) {
    require(object.label > 0 && object.label < static_cast<int>(classes),
            "an object has label " + std::to_string(object.label) + " of " +
                std::to_string(classes) + " classes",
            "labels of objects count from 1 to classes() - 1");
    require(object.box.empty() || (object.box & image) == object.box,
            "the box of an object is not in the image", "boxes are in pixels of the frame");
  }
}

void check_keyframe(const KeyFrame& keyframe, const Frame& frame, const SparseMap& map,
                    KeyFrameId next) {
  require(keyframe.id == next,
          "the key frame has id " + std::to_string(keyframe.id) + ", but the next one is " +
              std::to_string(next),
          "take TrackHints::next_keyframe");
  require(keyframe.frame == frame.index,
          "the key frame is of frame " + std::to_string(keyframe.frame),
          "KeyFrame::frame must be the index of the frame that was tracked");
  require(keyframe.camera != nullptr, "the key frame has no camera", "give it that of the frame");
  require(keyframe.features != nullptr, "the key frame has no features",
          "a tracker without point features gives an empty Features");
  require(is_pose(keyframe.world_from_camera), "the pose of the key frame is no rigid motion",
          "it must be finite, with an orthonormal rotation");
  const Features& features = *keyframe.features;
  const std::size_t count = features.size();
  for (const std::size_t size :
       {features.descriptors.size(), features.depth.size(), keyframe.track_weights.size(),
        keyframe.map_weights.size(), keyframe.landmarks.size()})
    require(size == count,
            "the key frame has " + std::to_string(count) + " keypoints, but " +
                std::to_string(size) + " descriptors, depths, weights or landmarks",
            "give one of each per keypoint");
  require(
      std::ranges::all_of(keyframe.landmarks,
                          [&](LandmarkId id) { return id == kNoId || id < map.landmark_id_end(); }),
      "the key frame sees a landmark that is not in the map",
      "use ids of the map that track() was given");
}

}  // namespace

void check_frame(const Frame& frame, std::uint32_t index, const Frame* previous) {
  require(frame.index == index, "the frame has index " + std::to_string(frame.index),
          "indices count from 0 without gaps");
  require(std::isfinite(frame.time), "the time of the frame is not finite",
          "give the time of the colour image in seconds");
  require(!previous || frame.time >= previous->time,
          "the frame is " + std::to_string(previous ? previous->time - frame.time : 0) +
              " s older than the one before",
          "give frames in order of time");
  require(!frame.gray.empty(), "the frame has no image", "leave out images that cannot be read");
  require(frame.bgr.size() == frame.gray.size() && frame.depth.size() == frame.gray.size(),
          "the colour, grey and depth images of a frame differ in size",
          "all three are needed, of the camera's size");
  check_type(frame.bgr, CV_8UC3, "the colour image");
  check_type(frame.gray, CV_8UC1, "the grey image");
  check_type(frame.depth, CV_32FC1, "the depth image");
  require(frame.camera != nullptr, "the frame has no camera", "set Frame::camera");
  require(frame.gray.size() == cv::Size(frame.camera->width, frame.camera->height),
          "the images have " + size_text(frame.gray.size()) + " pixels, the camera " +
              size_text({frame.camera->width, frame.camera->height}),
          "give images of the camera's size");
  require(!previous || previous->gray.size() == frame.gray.size(),
          "the images have another size than those before", "all images of a run have one size");
}

void check_segmentation(const Segmentation& segmentation, cv::Size frame, std::size_t classes) {
  if (!segmentation.known()) return;
  check_image(segmentation.labels, CV_8UC1, frame, "the labels",
              "the segmenter must give one byte per pixel of the frame");
  const int label = highest(segmentation.labels);
  require(label < std::max(1, static_cast<int>(classes)),
          "a pixel has label " + std::to_string(label) + ", but there are " +
              std::to_string(classes) + " classes",
          "labels count from 0, the background, to classes() - 1");
  check_objects(segmentation, classes);
  if (segmentation.instances.empty()) return;
  check_image(segmentation.instances, CV_8UC1, frame, "the instances",
              "the segmenter must give one byte per pixel of the frame");
  const int instance = highest(segmentation.instances);
  require(instance <= static_cast<int>(segmentation.objects.size()),
          "a pixel belongs to object " + std::to_string(instance) + " of " +
              std::to_string(segmentation.objects.size()),
          "the segmenter must number its instances from 1, as in its list of objects");
}

void check_moving_points(const MovingPoints& moving) {
  require(std::ranges::all_of(moving.points,
                              [](const PointMotion& point) {
                                return std::isfinite(point.previous.x + point.previous.y +
                                                     point.current.x + point.current.y);
                              }),
          "a point is not finite", "leave out points that were not found again");
  require(!moving.camera_motion || is_pose(*moving.camera_motion),
          "the camera's motion is no rigid motion",
          "leave camera_motion empty where it was not found");
}

void check_evidence(const MapEvidence& evidence) {
  if (!evidence.log_odds.empty()) check_type(evidence.log_odds, CV_32FC1, "the evidence");
}

void check_weights(const StaticWeights& weights, const Segmentation& segmentation, cv::Size frame) {
  for (const cv::Mat* image : {&weights.track, &weights.map})
    if (!image->empty())
      check_image(*image, CV_8UC1, frame, "the weights",
                  "the decision must give one byte per pixel of the frame, or nothing");
  require(
      weights.object_moves.empty() || weights.object_moves.size() == segmentation.objects.size(),
      std::to_string(weights.object_moves.size()) + " objects are judged, but there are " +
          std::to_string(segmentation.objects.size()),
      "object_moves has one entry per object of the labels, or none");
}

void check_prepared(const PreparedFrame* prepared, const Frame& frame) {
  require(prepared != nullptr, "prepare() gave nothing",
          "give a PreparedFrame with the frame, of your own type or not");
  require(prepared->frame.get() == &frame, "prepare() gave another frame",
          "make it with the frame that prepare() was given");
}

void check_tracking(const TrackResult& result, const Frame& frame, const SparseMap& map,
                    KeyFrameId next) {
  if (result.keyframe) check_keyframe(*result.keyframe, frame, map, next);
  if (result.state != TrackState::kTracking) return;
  require(is_pose(result.world_from_camera) && is_pose(result.reference_from_camera),
          "the pose is no rigid motion",
          "it must be finite, with an orthonormal rotation; say kLost where there is none");
  const KeyFrameId end = next + (result.keyframe ? 1 : 0);
  require(result.reference < end,
          "the reference is key frame " +
              (result.reference == kNoId ? "kNoId" : std::to_string(result.reference)) + " of " +
              std::to_string(end),
          "TrackResult::reference must be a key frame of the map, or the one just made");
}

}  // namespace stillpoint
