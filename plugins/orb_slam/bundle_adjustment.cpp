#include "orb_slam/bundle_adjustment.hpp"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <set>

#include "orb_slam/ceres_solver.hpp"
#include "orb_slam/landmark_geometry.hpp"
#include "orb_slam/pose_solver.hpp"
#include "orb_slam/scale_pyramid.hpp"

namespace stillpoint::orb {
namespace {

constexpr double kMinDepth = 0.05;         // metres; nearer points give no residual
constexpr std::size_t kMinLandmarks = 20;  // that a key frame must see to be moved by them

// camera_from_world as a change against the pose at the start: translation is added, rotation (a
// rotation vector) multiplied from the left. Changes stay small, which keeps the parametrisation
// far from its singularity and needs no manifold.
struct CameraState {
  KeyFrameId id = kNoId;
  Pose start;
  std::array<double, 6> change{};  // metres, radians

  Pose camera_from_world() const {
    Pose pose = start;
    pose.translation() += Eigen::Map<const Eigen::Vector3d>(change.data());
    pose.linear() = exp_so3(Eigen::Map<const Eigen::Vector3d>(change.data() + 3)) * start.linear();
    return pose;
  }
};

// Normalised measurement of a landmark.
struct Measurement {
  double fx, fy, cx, cy;
  double u, v, inverse_depth;         // inverse_depth 0 = none
  double pixel_weight, depth_weight;  // one over the standard deviation, times sqrt(weight)
};

// Residuals at a point in the camera, with their derivatives by that point.
void evaluate(const Measurement& m, const Eigen::Vector3d& p, Eigen::Vector3d& r,
              Eigen::Matrix3d* by_point) {
  r.setZero();
  if (by_point) by_point->setZero();
  if (p.z() < kMinDepth) return;
  const double iz = 1.0 / p.z();
  r.x() = m.pixel_weight * (m.fx * p.x() * iz + m.cx - m.u);
  r.y() = m.pixel_weight * (m.fy * p.y() * iz + m.cy - m.v);
  r.z() = m.depth_weight * (iz - m.inverse_depth);
  if (!by_point) return;
  *by_point << m.pixel_weight * m.fx * iz, 0, -m.pixel_weight * m.fx * p.x() * iz * iz,  //
      0, m.pixel_weight * m.fy * iz, -m.pixel_weight * m.fy * p.y() * iz * iz,           //
      0, 0, -m.depth_weight * iz * iz;
}

using RowMajor36 = Eigen::Matrix<double, 3, 6, Eigen::RowMajor>;
using RowMajor33 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

class MovingCameraCost final : public ceres::SizedCostFunction<3, 6, 3> {
 public:
  MovingCameraCost(const Measurement& m, const CameraState& camera) : m_(m), camera_(camera) {}

  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override {
    const Eigen::Map<const Eigen::Vector3d> dt(parameters[0]), omega(parameters[0] + 3);
    const Eigen::Matrix3d rotation = exp_so3(omega) * camera_.start.linear();
    const Eigen::Vector3d turned = rotation * Eigen::Map<const Eigen::Vector3d>(parameters[1]);
    const Eigen::Vector3d p = turned + camera_.start.translation() + dt;
    Eigen::Vector3d r;
    Eigen::Matrix3d by_point;
    evaluate(m_, p, r, jacobians ? &by_point : nullptr);
    Eigen::Map<Eigen::Vector3d>{residuals} = r;
    if (!jacobians) return true;
    if (jacobians[0]) {
      // d(exp(omega) x)/d omega = -skew(exp(omega) x) * left Jacobian, here to first order.
      Eigen::Map<RowMajor36> j(jacobians[0]);
      j.leftCols<3>() = by_point;
      j.rightCols<3>() =
          -by_point * skew(turned) * (Eigen::Matrix3d::Identity() + 0.5 * skew(omega));
    }
    if (jacobians[1]) Eigen::Map<RowMajor33>{jacobians[1]} = by_point * rotation;
    return true;
  }

 private:
  Measurement m_;
  const CameraState& camera_;
};

class FixedCameraCost final : public ceres::SizedCostFunction<3, 3> {
 public:
  FixedCameraCost(const Measurement& m, const Pose& camera_from_world)
      : m_(m), camera_from_world_(camera_from_world) {}

  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override {
    const Eigen::Vector3d p = camera_from_world_ * Eigen::Map<const Eigen::Vector3d>(parameters[0]);
    Eigen::Vector3d r;
    Eigen::Matrix3d by_point;
    evaluate(m_, p, r, jacobians ? &by_point : nullptr);
    Eigen::Map<Eigen::Vector3d>{residuals} = r;
    if (jacobians && jacobians[0])
      Eigen::Map<RowMajor33>{jacobians[0]} = by_point * camera_from_world_.linear();
    return true;
  }

 private:
  Measurement m_;
  const Pose& camera_from_world_;
};

bool sees_few(const KeyFrame& keyframe) {
  return keyframe.landmarks.size() -
             static_cast<std::size_t>(std::ranges::count(keyframe.landmarks, kNoId)) <
         kMinLandmarks;
}

// Cameras that move, points, and further cameras that see the points and stay.
class BundleProblem {
 public:
  BundleProblem(const SparseMap& map, std::vector<KeyFrameId> moving,
                const std::vector<LandmarkId>& points)
      : map_(map), moving_index_(map.keyframe_id_end(), -1) {
    // The origin stays, and so does what depth rather than landmarks holds.
    std::erase_if(moving, [&](KeyFrameId id) { return id == 0 || sees_few(*map.keyframe(id)); });
    for (const KeyFrameId id : moving) {
      moving_index_[id] = static_cast<int>(moving_.size());
      moving_.push_back({id, map.keyframe(id)->world_from_camera.inverse()});
    }
    for (const LandmarkId id : points)
      points_.emplace_back(id, map.landmark(id)->position_in_world);
    for (auto& [id, position] : points_) add_point(id, position);
  }

  /// Whether there is a result.
  bool solve(const BundleOptions& options, std::stop_token hurry) {
    if (problem_.NumResidualBlocks() == 0) return false;
    StopCallback stop(std::move(hurry));
    ceres::Solver::Options solver =
        solver_options(ceres::SPARSE_SCHUR, options.max_iterations, stop);
    solver.num_threads = options.threads;
    solver.linear_solver_ordering = std::make_shared<ceres::ParameterBlockOrdering>();
    for (auto& [id, position] : points_)
      if (problem_.HasParameterBlock(position.data()))
        solver.linear_solver_ordering->AddElementToGroup(position.data(), 0);
    for (CameraState& camera : moving_)
      if (problem_.HasParameterBlock(camera.change.data()))
        solver.linear_solver_ordering->AddElementToGroup(camera.change.data(), 1);
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem_, &summary);
    return summary.IsSolutionUsable();
  }

  std::vector<MovedKeyFrame> keyframes() const {
    std::vector<MovedKeyFrame> moved;
    for (const CameraState& camera : moving_)
      moved.push_back({camera.id, orthonormalised(camera.camera_from_world().inverse())});
    return moved;
  }
  const std::vector<std::pair<LandmarkId, Eigen::Vector3d>>& landmarks() const { return points_; }

 private:
  void add_point(LandmarkId id, Eigen::Vector3d& position) {
    for (const Observation& o : map_.landmark(id)->observations) {
      const KeyFrame& keyframe = *map_.keyframe(o.keyframe);
      const Measurement m = measurement(keyframe, o.feature);
      if (const int moving = moving_index_[o.keyframe]; moving >= 0) {
        CameraState& camera = moving_[static_cast<std::size_t>(moving)];
        auto& cost = moving_costs_.emplace_back(m, camera);
        problem_.AddResidualBlock(&cost, &loss_, camera.change.data(), position.data());
      } else {
        auto [fixed, is_new] = fixed_.try_emplace(o.keyframe);
        if (is_new) fixed->second = keyframe.world_from_camera.inverse();
        auto& cost = fixed_costs_.emplace_back(m, fixed->second);
        problem_.AddResidualBlock(&cost, &loss_, position.data());
      }
    }
  }

  static Measurement measurement(const KeyFrame& keyframe, std::uint32_t feature) {
    const Features& features = *keyframe.features;
    const cv::KeyPoint& k = features.keypoints[feature];
    const double trust = std::sqrt(keyframe.track_weights[feature] / 255.0);
    const double sigma = ScalePyramid(features).pixel_sigma(k.octave);
    const double depth = features.depth[feature];
    const Camera& c = *keyframe.camera;
    return {c.fx,
            c.fy,
            c.cx,
            c.cy,
            k.pt.x,
            k.pt.y,
            depth > 0 ? 1.0 / depth : 0.0,
            trust / sigma,
            depth > 0 ? trust / c.depth_noise : 0.0};
  }

  static ceres::Problem::Options problem_options() {
    ceres::Problem::Options options;
    options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    options.disable_all_safety_checks = true;
    return options;
  }

  const SparseMap& map_;
  std::map<KeyFrameId, Pose> fixed_;
  std::vector<int> moving_index_;  // of moving_, by key frame id; -1 = does not move
  // Parameters lie in arrays, because Ceres orders them by address: results repeat to the bit.
  std::vector<CameraState> moving_;
  std::vector<std::pair<LandmarkId, Eigen::Vector3d>> points_;
  std::deque<MovingCameraCost> moving_costs_;
  std::deque<FixedCameraCost> fixed_costs_;
  ceres::HuberLoss loss_{std::sqrt(kChiSquare3)};
  ceres::Problem problem_{problem_options()};
};

std::vector<KeyFrameId> most_covisible(const SparseMap& map, KeyFrameId centre, int count) {
  std::vector<KeyFrameId> ids{centre};
  for (const Covisibility& c : map.keyframe(centre)->covisible)
    if (static_cast<int>(ids.size()) < count) ids.push_back(c.keyframe);
  return ids;
}

std::vector<LandmarkId> seen_by(const SparseMap& map, const std::vector<KeyFrameId>& keyframes) {
  std::set<LandmarkId> ids;
  for (const KeyFrameId keyframe : keyframes)
    for (const LandmarkId id : map.keyframe(keyframe)->landmarks)
      if (id != kNoId) ids.insert(id);
  return {ids.begin(), ids.end()};
}

void drop_outliers(MapEdit& edit, LandmarkId id) {
  const std::vector<Observation> observations = edit.map().landmark(id)->observations;
  for (const Observation& o : observations) {
    const Landmark* landmark = edit.map().landmark(id);
    if (!landmark) return;
    const KeyFrame& keyframe = *edit.map().keyframe(o.keyframe);
    if (!observation_error(landmark->position_in_world, keyframe.world_from_camera.inverse(),
                           keyframe, o.feature)
             .fits())
      edit.remove_observation(id, o.keyframe);
  }
}

}  // namespace

std::vector<LandmarkId> adjust_locally(MapEdit& edit, KeyFrameId centre,
                                       const BundleOptions& options, std::stop_token hurry) {
  const std::vector<KeyFrameId> local = most_covisible(edit.map(), centre, options.max_keyframes);
  std::vector<LandmarkId> points = seen_by(edit.map(), local);
  BundleProblem problem(edit.map(), local, points);
  if (!problem.solve(options, std::move(hurry))) return {};
  for (const MovedKeyFrame& moved : problem.keyframes())
    edit.keyframe(moved.keyframe).world_from_camera = moved.world_from_camera;
  for (const auto& [id, position] : problem.landmarks())
    edit.landmark(id).position_in_world = position;
  for (const LandmarkId id : points) drop_outliers(edit, id);
  return points;
}

std::optional<MapCorrection> adjust_all(const SparseMap& map, const BundleOptions& options,
                                        std::stop_token hurry) {
  std::vector<KeyFrameId> keyframes;
  for (KeyFrameId id = 0; id < map.keyframe_id_end(); ++id)
    if (map.keyframe(id)) keyframes.push_back(id);
  BundleProblem problem(map, keyframes, seen_by(map, keyframes));
  if (!problem.solve(options, std::move(hurry))) return std::nullopt;
  return MapCorrection{.base_version = map.version(),
                       .keyframe_id_end = static_cast<KeyFrameId>(map.keyframe_id_end()),
                       .moved = problem.keyframes(),
                       .landmarks = problem.landmarks()};
}

}  // namespace stillpoint::orb
