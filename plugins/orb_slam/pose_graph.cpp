#include "orb_slam/pose_graph.hpp"

#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <deque>
#include <stop_token>
#include <utility>

namespace stillpoint::orb_slam {
namespace {

constexpr int kMinShared = 100;  // landmarks, of an edge of the essential graph
// Standard deviations of the pose between two key frames that share so many landmarks.
constexpr double kMetres = 0.01;
constexpr double kRadians = 0.005;
constexpr int kGraphIterations = 30;

// Ends with the best result so far, after the current iteration.
class StopCallback final : public ceres::IterationCallback {
 public:
  explicit StopCallback(std::stop_token stop) : stop_(std::move(stop)) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary&) override {
    return stop_.stop_requested() ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

 private:
  std::stop_token stop_;
};

ceres::Solver::Options solver_options(StopCallback& stop) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  // CHOLMOD, the default, starts threads of its own and rounds as the machine's BLAS does.
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  options.max_num_iterations = kGraphIterations;
  options.logging_type = ceres::SILENT;
  options.callbacks = {&stop};
  return options;
}

// world_from_keyframe; Ceres changes the quaternion on its manifold.
struct PoseState {
  KeyFrameId id = kNoId;
  Eigen::Quaterniond rotation;
  Eigen::Vector3d translation;
};

// Relative pose error of an edge: estimated against measured pose of b in a.
class EdgeError {
 public:
  /// `covariance` is that of b in its own frame, beside the usual one of an edge.
  EdgeError(const Pose& a_from_b, const Matrix6d& covariance)
      : rotation_(a_from_b.linear()), translation_(a_from_b.translation()) {
    Matrix6d turn = Matrix6d::Zero();  // residuals are in the frame of a
    turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = a_from_b.linear();
    Matrix6d sum = turn * covariance * turn.transpose();
    sum.diagonal().head<3>().array() += kMetres * kMetres;
    sum.diagonal().tail<3>().array() += kRadians * kRadians;
    // Information is the product of the upper triangle with its transpose from the left.
    const Matrix6d information = sum.llt().solve(Matrix6d::Identity());
    root_ = information.llt().matrixU();
  }

  template <class T>
  bool operator()(const T* qa, const T* ta, const T* qb, const T* tb, T* residuals) const {
    using Vector = Eigen::Matrix<T, 3, 1>;
    const Eigen::Map<const Eigen::Quaternion<T>> a(qa), b(qb);
    const Eigen::Quaternion<T> world_in_a = a.conjugate();
    const Vector translation =
        world_in_a * (Eigen::Map<const Vector>(tb) - Eigen::Map<const Vector>(ta));
    const Eigen::Quaternion<T> turn =
        rotation_.cast<T>() * (world_in_a * b).conjugate();  // identity when they agree
    Eigen::Matrix<T, 6, 1> error;
    error << translation - translation_.cast<T>(), T(2.0) * turn.vec();
    Eigen::Map<Eigen::Matrix<T, 6, 1>>{residuals} = root_.cast<T>() * error;
    return true;
  }

 private:
  Eigen::Quaterniond rotation_;
  Eigen::Vector3d translation_;
  Matrix6d root_;
};

KeyFrameId this_or_older(const SparseMap& map, KeyFrameId id) {
  while (!map.keyframe(id)) --id;  // the oldest one is never removed
  return id;
}

// Culling takes the ends of closed loops first: both sides see the same landmarks.
PoseEdge between_living(const SparseMap& map, const PoseEdge& edge) {
  const KeyFrameId a = this_or_older(map, edge.a), b = this_or_older(map, edge.b);
  const auto relative = [&](KeyFrameId from, KeyFrameId to) {
    return map.world_from_keyframe(from).inverse() * map.world_from_keyframe(to);
  };
  return {a, b, relative(a, edge.a) * edge.a_from_b * relative(edge.b, b)};
}

class PoseGraph {
 public:
  explicit PoseGraph(const SparseMap& map) : state_of_(map.keyframe_id_end(), nullptr) {
    for (KeyFrameId id = 0; id < map.keyframe_id_end(); ++id) {
      if (!map.keyframe(id)) continue;
      const Pose& pose = map.keyframe(id)->world_from_camera;
      states_.push_back({id, Eigen::Quaterniond(pose.linear()), pose.translation()});
      state_of_[id] = &states_.back();
    }
    for (PoseState& state : states_) {
      problem_.AddParameterBlock(state.rotation.coeffs().data(), 4, &manifold_);
      problem_.AddParameterBlock(state.translation.data(), 3);
    }
    problem_.SetParameterBlockConstant(states_.front().rotation.coeffs().data());
    problem_.SetParameterBlockConstant(states_.front().translation.data());
  }

  void add(const PoseEdge& edge, const Matrix6d& covariance = Matrix6d::Zero()) {
    PoseState* a = state_of_[edge.a];
    PoseState* b = state_of_[edge.b];
    if (a == b) return;
    auto* cost = new ceres::AutoDiffCostFunction<EdgeError, 6, 4, 3, 4, 3>(  // owned by problem_
        new EdgeError(edge.a_from_b, covariance));
    problem_.AddResidualBlock(cost, nullptr, a->rotation.coeffs().data(), a->translation.data(),
                              b->rotation.coeffs().data(), b->translation.data());
  }

  bool solve(std::stop_token stop) {
    StopCallback callback(std::move(stop));
    ceres::Solver::Summary summary;
    ceres::Solve(solver_options(callback), &problem_, &summary);
    return summary.IsSolutionUsable();
  }

  std::vector<MovedKeyFrame> result() const {
    std::vector<MovedKeyFrame> moved;
    for (const PoseState& state : states_) {
      Pose pose = Pose::Identity();
      pose.linear() = state.rotation.normalized().toRotationMatrix();
      pose.translation() = state.translation;
      moved.push_back({state.id, pose});
    }
    return moved;
  }

 private:
  static ceres::Problem::Options problem_options() {
    ceres::Problem::Options options;
    options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    return options;
  }

  ceres::EigenQuaternionManifold manifold_;
  std::deque<PoseState> states_;      // stay where they are
  std::vector<PoseState*> state_of_;  // by key frame id
  ceres::Problem problem_{problem_options()};
};

PoseEdge edge_between(const SparseMap& map, KeyFrameId a, KeyFrameId b) {
  return {a, b, map.world_from_keyframe(a).inverse() * map.world_from_keyframe(b)};
}

}  // namespace

std::vector<MovedKeyFrame> optimise_pose_graph(const SparseMap& map,
                                               std::span<const PoseEdge> loops,
                                               std::stop_token stop) {
  PoseGraph graph(map);
  for (KeyFrameId id = 0; id < map.keyframe_id_end(); ++id) {
    const KeyFrame* keyframe = map.keyframe(id);
    if (!keyframe) continue;
    if (keyframe->parent != kNoId)
      graph.add(edge_between(map, keyframe->parent, id), keyframe->covariance);
    for (const Covisibility& c : keyframe->covisible)
      if (c.shared >= kMinShared && c.keyframe < id && c.keyframe != keyframe->parent)
        graph.add(edge_between(map, c.keyframe, id));
  }
  for (const PoseEdge& loop : loops) graph.add(between_living(map, loop));
  if (!graph.solve(std::move(stop))) return {};
  return graph.result();
}

}  // namespace stillpoint::orb_slam
