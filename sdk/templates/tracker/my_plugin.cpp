#include "my_plugin.hpp"

#include <cstring>
#include <memory>
#include <optional>
#include <stillpoint/support/rigid_motion.hpp>
#include <utility>

namespace plugins::my_plugin {
namespace {

using stillpoint::Features;
using stillpoint::Pose;
using stillpoint::TrackedFeature;

constexpr int kSamples = 200;  // of RANSAC

struct PreparedFeatures final : stillpoint::PreparedFrame {
  using PreparedFrame::PreparedFrame;
  std::shared_ptr<Features> features = std::make_shared<Features>();
};

std::vector<std::uint8_t> at_features(const cv::Mat& weights, const Features& features) {
  std::vector<std::uint8_t> values;
  for (const cv::KeyPoint& keypoint : features.keypoints)
    values.push_back(stillpoint::StaticWeights::at(weights, keypoint.pt.x, keypoint.pt.y));
  return values;
}

/// Descriptors as OpenCV wants them, without a copy.
cv::Mat rows_of(const Features& features) {
  return {static_cast<int>(features.size()), 32, CV_8UC1,
          const_cast<stillpoint::Descriptor*>(features.descriptors.data())};
}

}  // namespace

struct MyPlugin::Registration {
  std::optional<Pose> reference_from_camera;
  std::vector<TrackedFeature> tracked;  // per feature of the frame
  int matches = 0;
  int inliers = 0;
};

void MyPlugin::Options::visit(stillpoint::OptionVisitor& v) {
  v("features", features, {.min = 50, .max = 10000, .help = "extracted from each frame"});
  v("pixel_noise", pixel_noise,
    {.min = 0.1, .max = 10, .unit = "px", .help = "standard deviation of a feature's position"});
  v("min_inliers", min_inliers, {.min = 6, .help = "with fewer, tracking is lost"});
  v("keyframe_share", keyframe_share,
    {.min = 0,
     .max = 1,
     .help = "of the key frame's first inliers; with fewer, a new one is made"});
  v("keyframe_distance", keyframe_distance,
    {.min = 0, .unit = "m", .help = "from the last key frame to the next, at most"});
}

MyPlugin::MyPlugin(const Options& options, const stillpoint::StageContext& context)
    : options_(options), seed_(context.seed), orb_(cv::ORB::create(options.features)) {}

stillpoint::PreparedFramePtr MyPlugin::prepare(stillpoint::FramePtr frame) {
  auto prepared = std::make_unique<PreparedFeatures>(std::move(frame));
  Features& features = *prepared->features;
  features.scale_factor = orb_->getScaleFactor();
  features.levels = orb_->getNLevels();
  cv::Mat descriptors;
  orb_->detectAndCompute(prepared->frame->gray, cv::noArray(), features.keypoints, descriptors);
  for (int i = 0; i < descriptors.rows; ++i) {
    std::memcpy(features.descriptors.emplace_back().data(), descriptors.ptr(i),
                sizeof(stillpoint::Descriptor));
    const cv::Point2f& at = features.keypoints[static_cast<std::size_t>(i)].pt;
    const float depth = prepared->frame->depth.at<float>(cvRound(at.y), cvRound(at.x));
    features.depth.push_back(depth > 0 ? depth : 0);  // some sources say by NaN: not measured
  }
  return prepared;
}

stillpoint::TrackResult MyPlugin::track(stillpoint::PreparedFramePtr prepared,
                                        const stillpoint::StaticWeights& weights,
                                        const stillpoint::SparseMap& map,
                                        stillpoint::TrackHints hints) {
  const auto& current = static_cast<const PreparedFeatures&>(*prepared);
  const stillpoint::FeaturesPtr features = current.features;
  const std::vector<std::uint8_t> of_features = at_features(weights.track, *features);
  stillpoint::TrackResult result{.features = static_cast<int>(features->size())};
  if (!reference_ && !map.empty()) {  // of another run: where in it the camera is, is not known
    result.state = stillpoint::TrackState::kLost;
    return result;
  }
  if (!reference_) {
    int usable = 0;
    for (std::size_t i = 0; i < features->size(); ++i)
      usable += features->depth[i] > 0 && of_features[i] > 0;
    if (hints.localise_only || usable < 2 * options_.min_inliers) return result;  // kWaiting
    result.state = stillpoint::TrackState::kTracking;
    begin_keyframe(result, *current.frame, features, weights, hints);
    return result;
  }
  Registration found = registered(*features, *current.frame->camera, of_features);
  result.matches = found.matches;
  result.inliers = found.inliers;
  result.tracked = std::move(found.tracked);
  if (!found.reference_from_camera) {
    result.state = stillpoint::TrackState::kLost;
    return result;
  }
  reference_from_last_ = *found.reference_from_camera;
  result.state = stillpoint::TrackState::kTracking;
  result.reference = reference_id_;
  result.reference_from_camera = reference_from_last_;
  result.world_from_camera = world_from_reference(map) * reference_from_last_;
  if (reference_inliers_ == 0) reference_inliers_ = found.inliers;
  const bool due = reference_from_last_.translation().norm() > options_.keyframe_distance ||
                   found.inliers < options_.keyframe_share * reference_inliers_;
  if (due && !hints.localise_only) begin_keyframe(result, *current.frame, features, weights, hints);
  return result;
}

MyPlugin::Registration MyPlugin::registered(const Features& current,
                                            const stillpoint::Camera& camera,
                                            const std::vector<std::uint8_t>& weights) const {
  Registration result;
  for (std::size_t i = 0; i < current.size(); ++i)
    result.tracked.push_back({current.keypoints[i].pt, weights[i] > 0
                                                           ? TrackedFeature::Use::kUnmatched
                                                           : TrackedFeature::Use::kMoving});
  std::vector<cv::DMatch> matches;
  if (current.size() > 0)
    cv::BFMatcher(cv::NORM_HAMMING, true).match(rows_of(current), rows_of(*reference_), matches);
  const auto point = [&](const Features& features, std::size_t i) -> Eigen::Vector3d {
    const cv::Point2f& at = features.keypoints[i].pt;
    return camera.unproject(at.x, at.y, features.depth[i]);
  };
  std::vector<stillpoint::RigidMatch> pairs;
  std::vector<std::size_t> of_current;
  for (const cv::DMatch& match : matches) {
    const auto i = static_cast<std::size_t>(match.queryIdx);
    const auto k = static_cast<std::size_t>(match.trainIdx);
    if (!(current.depth[i] > 0) || !(reference_->depth[k] > 0)) continue;
    if (weights[i] == 0 || reference_weights_[k] == 0) continue;
    const cv::Point2f& at = current.keypoints[i].pt;
    pairs.push_back({.in_source = point(*reference_, k),
                     .in_target = point(current, i),
                     .pixel = {at.x, at.y},
                     .weight = weights[i] / 255.0});
    of_current.push_back(i);
  }
  result.matches = static_cast<int>(pairs.size());
  const std::vector<Pose> guesses = {reference_from_last_.inverse()};
  const auto motion = stillpoint::find_rigid_motion(
      pairs, camera, {.pixel = options_.pixel_noise, .inverse_depth = camera.depth_noise}, guesses,
      kSamples, seed_);
  if (!motion) return result;
  result.inliers = motion->inliers;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    result.tracked[of_current[i]].use =
        motion->inlier[i] ? TrackedFeature::Use::kInlier : TrackedFeature::Use::kOutlier;
  if (motion->inliers >= options_.min_inliers)
    result.reference_from_camera = motion->target_from_source.inverse();
  return result;
}

/// What follows is tracked against this frame.
void MyPlugin::begin_keyframe(stillpoint::TrackResult& result, const stillpoint::Frame& frame,
                              stillpoint::FeaturesPtr features,
                              const stillpoint::StaticWeights& weights,
                              stillpoint::TrackHints hints) {
  stillpoint::KeyFrame keyframe{.id = hints.next_keyframe,
                                .frame = frame.index,
                                .time = frame.time,
                                .world_from_camera = result.world_from_camera,
                                .camera = frame.camera,
                                .features = features};
  keyframe.track_weights = at_features(weights.track, *features);
  keyframe.map_weights = at_features(weights.map, *features);
  keyframe.landmarks.assign(features->size(), stillpoint::kNoId);  // it needs none
  reference_ = std::move(features);
  reference_weights_ = keyframe.track_weights;
  reference_inliers_ = 0;
  reference_id_ = result.reference = keyframe.id;
  reference_from_last_ = result.reference_from_camera = Pose::Identity();
  world_from_new_reference_ = result.world_from_camera;
  result.keyframe = std::move(keyframe);
}

/// Its pose in the map or, while it is not there yet, its tracked pose.
Pose MyPlugin::world_from_reference(const stillpoint::SparseMap& map) const {
  return reference_id_ < map.keyframe_id_end() ? map.world_from_keyframe(reference_id_)
                                               : world_from_new_reference_;
}

}  // namespace plugins::my_plugin

// What the library provides: the type `my_plugin`.
STILLPOINT_PLUGIN(my_plugin, "0.1.0",
                  stillpoint::provide<stillpoint::Tracker, plugins::my_plugin::MyPlugin>(
                      "my_plugin", "odometry: ORB features against the last key frame"));
