#include "orb_slam/observed_frame.hpp"

#include <algorithm>

#include "orb_slam/landmark_geometry.hpp"

namespace stillpoint::orb_slam {
namespace {

// More is a depth discontinuity: a share of the depth, but no less than so many standard deviations
// of a pixel's depth, which grows with its square.
constexpr float kMaxDepthStep = 0.04f;
constexpr float kMinStepSigmas = 4.0f;
constexpr int kDepthWindow = 3;         // px around a keypoint
constexpr double kMinNewWeight = 0.02;  // least weight of a new landmark

// Depth of the surface a keypoint lies on; 0 beside a depth discontinuity, where it may be that of
// the other side. Such features made estimated motions 0.5 to 1 % too small, since their errors are
// biased towards the foreground.
float depth_at(const cv::Mat& depth, float surface_noise, cv::Point2f pixel) {
  const int u = cvRound(pixel.x), v = cvRound(pixel.y);
  const float centre = depth.at<float>(v, u);
  if (!(centre > 0)) return 0.0f;  // nothing measured; some sources say it by NaN
  const float limit = centre * std::max(kMaxDepthStep, kMinStepSigmas * surface_noise * centre);
  for (int y = std::max(v - kDepthWindow, 0); y <= std::min(v + kDepthWindow, depth.rows - 1);
       ++y) {
    const float* row = depth.ptr<float>(y);
    for (int x = std::max(u - kDepthWindow, 0); x <= std::min(u + kDepthWindow, depth.cols - 1);
         ++x)
      if (row[x] > 0 && std::abs(row[x] - centre) > limit) return 0.0f;
  }
  return centre;
}

ObservedFrame unmatched(FramePtr frame, FeaturesPtr features) {
  const std::size_t count = features->size();
  ObservedFrame observed;
  observed.grid = FeatureGrid(*features, *frame->camera);
  observed.features = std::move(features);
  observed.frame = std::move(frame);
  observed.landmarks.assign(count, kNoId);
  observed.temporary.resize(count);
  observed.outlier.assign(count, false);
  observed.track_weights.assign(count, 255);
  observed.map_weights.assign(count, 255);
  return observed;
}

// Weight of a landmark by its age: on a person without a label yet, a few frames make hundreds of
// landmarks that are consistent with each other.
double probation_weight(const Landmark& landmark, const SparseMap& map, double time,
                        double probation) {
  const KeyFrame* creator = map.keyframe(landmark.created_by);
  if (!creator || time < creator->time) return 1;
  const double age = time - creator->time;
  const double share = age / probation;
  return age < probation ? std::max(share * share, kMinNewWeight) : 1;
}

}  // namespace

ObservedFrame observe(FramePtr frame, Features features) {
  features.depth.resize(features.size());
  const auto surface_noise = static_cast<float>(frame->camera->surface_noise);
  for (std::size_t i = 0; i < features.size(); ++i)
    features.depth[i] = depth_at(frame->depth, surface_noise, features.keypoints[i].pt);
  return unmatched(std::move(frame), std::make_shared<Features>(std::move(features)));
}

ObservedFrame observation_of(const KeyFrame& keyframe) {
  Frame frame{.index = keyframe.frame, .time = keyframe.time, .camera = keyframe.camera};
  ObservedFrame observed =
      unmatched(std::make_shared<const Frame>(std::move(frame)), keyframe.features);
  for (std::size_t i = 0; i < observed.track_weights.size(); ++i)
    observed.track_weights[i] =
        keyframe.map_weights[i] >= kMinMapWeight ? keyframe.track_weights[i] : std::uint8_t{0};
  return observed;
}

void ObservedFrame::set_weights(const StaticWeights& weights) {
  for (std::size_t i = 0; i < features->size(); ++i) {
    const cv::Point2f p = features->keypoints[i].pt;
    track_weights[i] = StaticWeights::at(weights.track, p.x, p.y);
    map_weights[i] = StaticWeights::at(weights.map, p.x, p.y);
  }
}

void ObservedFrame::clear_matches() {
  std::fill(landmarks.begin(), landmarks.end(), kNoId);
  drop_temporary();
  std::fill(outlier.begin(), outlier.end(), false);
}

void ObservedFrame::assign(std::span<const Match> matches) {
  for (const Match& m : matches) {
    landmarks[m.feature] = m.id;
    outlier[m.feature] = false;
  }
}

void ObservedFrame::drop_outliers() {
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    if (!outlier[i]) continue;
    landmarks[i] = kNoId;
    temporary[i].reset();
    outlier[i] = false;
  }
}

void ObservedFrame::drop_temporary() {
  std::fill(temporary.begin(), temporary.end(), std::nullopt);
}

int ObservedFrame::usable_count() const {
  return static_cast<int>(std::ranges::count_if(
      track_weights, [](std::uint8_t weight) { return weight >= kMinWeight; }));
}

int ObservedFrame::matched() const {
  return static_cast<int>(
      std::count_if(landmarks.begin(), landmarks.end(), [](LandmarkId id) { return id != kNoId; }));
}

int ObservedFrame::inlier_count() const {
  int inlier_count = 0;
  for (std::size_t i = 0; i < landmarks.size(); ++i)
    inlier_count += landmarks[i] != kNoId && !outlier[i];
  return inlier_count;
}

int solve_pose(ObservedFrame& observed, const SparseMap& map, double probation,
               KeyFrameId first_keyframe, const PoseTerm& term) {
  const Features& features = *observed.features;
  const ScalePyramid pyramid(features);
  std::vector<PoseObservation> observations;
  std::vector<std::uint32_t> index;
  for (std::uint32_t i = 0; i < features.size(); ++i) {
    const Landmark* landmark = map.landmark(observed.landmarks[i]);
    if (!landmark && !observed.temporary[i]) continue;
    const cv::KeyPoint& k = features.keypoints[i];
    const double sigma = pyramid.pixel_sigma(k.octave);
    const bool own = landmark && landmark->created_by >= first_keyframe;
    const double trust =
        own ? probation_weight(*landmark, map, observed.frame->time, probation) : 1;
    observations.push_back(
        {.point_in_world = landmark ? landmark->position_in_world : *observed.temporary[i],
         .pixel = {k.pt.x, k.pt.y},
         .inverse_depth = features.depth[i] > 0 ? 1.0 / features.depth[i] : 0.0,
         .pixel_sigma = sigma,
         .inverse_depth_sigma = observed.frame->camera->depth_noise,
         .weight = trust * observed.track_weights[i] / 255.0,
         .temporary = !landmark});
    index.push_back(i);
  }
  const PoseSolution solution =
      solve_pose(observations, *observed.frame->camera, observed.world_from_camera.inverse(), term);
  observed.world_from_camera = solution.camera_from_world.inverse();
  observed.information = solution.information;
  observed.temporary_information = solution.temporary_information;
  for (std::size_t i = 0; i < index.size(); ++i) observed.outlier[index[i]] = !solution.inlier[i];
  return solution.inliers;
}

}  // namespace stillpoint::orb_slam
