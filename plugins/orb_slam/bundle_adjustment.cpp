#include "orb_slam/bundle_adjustment.hpp"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <set>

#include "orb_slam/landmark_geometry.hpp"
#include "orb_slam/pose_solver.hpp"
#include "orb_slam/scale_pyramid.hpp"

namespace stillpoint::orb {
namespace {

constexpr double kMinDepth = 0.05;  // metres; nearer points give no residual

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

class StopCallback final : public ceres::IterationCallback {
 public:
  explicit StopCallback(std::stop_token hurry) : hurry_(std::move(hurry)) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary&) override {
    return hurry_.stop_requested() ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

 private:
  std::stop_token hurry_;
};

class LocalProblem {
 public:
  LocalProblem(const SparseMap& map, KeyFrameId centre, int max_keyframes) : map_(map) {
    choose_cameras(centre, max_keyframes);
    choose_points();
    for (auto& [id, position] : points_) add_point(id, position);
  }

  void solve(const BundleOptions& options, std::stop_token hurry) {
    if (problem_.NumResidualBlocks() == 0) return;
    StopCallback stop(std::move(hurry));
    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::SPARSE_SCHUR;
    solver.max_num_iterations = options.max_iterations;
    solver.num_threads = options.threads;
    solver.logging_type = ceres::SILENT;
    solver.callbacks = {&stop};
    solver.linear_solver_ordering = std::make_shared<ceres::ParameterBlockOrdering>();
    for (auto& [id, position] : points_)
      if (problem_.HasParameterBlock(position.data()))
        solver.linear_solver_ordering->AddElementToGroup(position.data(), 0);
    for (CameraState& camera : moving_)
      if (problem_.HasParameterBlock(camera.change.data()))
        solver.linear_solver_ordering->AddElementToGroup(camera.change.data(), 1);
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem_, &summary);
    usable_ = summary.IsSolutionUsable();
  }

  /// Writes the result and drops what does not fit it.
  std::vector<LandmarkId> store(MapEdit& edit) const {
    std::vector<LandmarkId> adjusted;
    if (!usable_) return adjusted;
    for (const CameraState& camera : moving_)
      edit.keyframe(camera.id).world_from_camera =
          orthonormalised(camera.camera_from_world().inverse());
    for (const auto& [id, position] : points_) {
      edit.landmark(id).position_in_world = position;
      adjusted.push_back(id);
    }
    for (const LandmarkId id : adjusted) drop_outliers(edit, id);
    return adjusted;
  }

 private:
  void choose_cameras(KeyFrameId centre, int max_keyframes) {
    std::vector<KeyFrameId> ids{centre};
    for (const Covisibility& c : map_.keyframe(centre)->covisible)
      if (static_cast<int>(ids.size()) < max_keyframes) ids.push_back(c.keyframe);
    local_ = ids;
    std::erase(ids, KeyFrameId{0});  // the origin stays
    for (const KeyFrameId id : ids)
      moving_.push_back({id, map_.keyframe(id)->world_from_camera.inverse()});
  }

  void choose_points() {
    std::set<LandmarkId> ids;
    for (const KeyFrameId keyframe : local_)
      for (const LandmarkId id : map_.keyframe(keyframe)->landmarks)
        if (id != kNoId) ids.insert(id);
    for (const LandmarkId id : ids) points_.emplace_back(id, map_.landmark(id)->position_in_world);
  }

  void add_point(LandmarkId id, Eigen::Vector3d& position) {
    for (const Observation& o : map_.landmark(id)->observations) {
      const KeyFrame& keyframe = *map_.keyframe(o.keyframe);
      const Measurement m = measurement(keyframe, o.feature);
      const auto moving =
          std::find_if(moving_.begin(), moving_.end(),
                       [&](const CameraState& camera) { return camera.id == o.keyframe; });
      if (moving != moving_.end()) {
        auto& cost = moving_costs_.emplace_back(m, *moving);
        problem_.AddResidualBlock(&cost, &loss_, moving->change.data(), position.data());
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

  static void drop_outliers(MapEdit& edit, LandmarkId id) {
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

  static ceres::Problem::Options problem_options() {
    ceres::Problem::Options options;
    options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    options.disable_all_safety_checks = true;
    return options;
  }

  const SparseMap& map_;
  std::vector<KeyFrameId> local_;
  std::map<KeyFrameId, Pose> fixed_;
  // Parameters lie in arrays, because Ceres orders them by address: results repeat to the bit.
  std::vector<CameraState> moving_;
  std::vector<std::pair<LandmarkId, Eigen::Vector3d>> points_;
  std::deque<MovingCameraCost> moving_costs_;
  std::deque<FixedCameraCost> fixed_costs_;
  ceres::HuberLoss loss_{std::sqrt(kChiSquare3)};
  ceres::Problem problem_{problem_options()};
  bool usable_ = false;
};

}  // namespace

std::vector<LandmarkId> adjust_locally(MapEdit& edit, KeyFrameId centre,
                                       const BundleOptions& options, std::stop_token hurry) {
  LocalProblem problem(edit.map(), centre, options.max_keyframes);
  problem.solve(options, std::move(hurry));
  return problem.store(edit);
}

}  // namespace stillpoint::orb
