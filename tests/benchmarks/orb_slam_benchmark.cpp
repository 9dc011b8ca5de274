// Time of the steps of tracking and local mapping, on a synthetic world.
#include <benchmark/benchmark.h>
#include <ceres/ceres.h>

#include "orb_slam/bundle_adjustment.hpp"
#include "orb_slam/pose_solver.hpp"
#include "orb_slam/test_world.hpp"

namespace stillpoint::orb_slam {
namespace {

bool all(std::uint32_t) { return true; }

std::vector<PoseObservation> pose_observations(const Camera& camera) {
  TestWorld random(0);
  std::vector<PoseObservation> observations;
  for (int i = 0; i < 500; ++i) {
    const double u = random.uniform(0, 639), v = random.uniform(0, 479), z = random.uniform(1, 6);
    observations.push_back({.point_in_world = camera.unproject(u, v, z),
                            .pixel = {u + random.normal(), v + random.normal()},
                            .inverse_depth = 1.0 / z + 0.01 * random.normal(),
                            .inverse_depth_sigma = 0.01});
  }
  return observations;
}

const Pose kPoseGuess = pose_at({0.05, 0.02, -0.03}, {0.01, -0.02, 0.01});

void solve_pose_500_points(benchmark::State& state) {
  const Camera camera;
  const std::vector<PoseObservation> observations = pose_observations(camera);
  for ([[maybe_unused]] auto _ : state)
    benchmark::DoNotOptimize(solve_pose(observations, camera, kPoseGuess));
}
BENCHMARK(solve_pose_500_points)->Unit(benchmark::kMicrosecond);

// The same residuals for Ceres: what the solver by hand has to be better than.
class CeresPoseCost final : public ceres::SizedCostFunction<3, 6> {
 public:
  CeresPoseCost(const PoseObservation& o, const Camera& camera) : o_(o), camera_(camera) {}
  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override {
    const Vector6d twist = Eigen::Map<const Vector6d>(parameters[0]);
    const Eigen::Vector3d p = exp_se3(twist) * (kPoseGuess * o_.point_in_world);
    const Eigen::Vector2d pixel = camera_.project(p);
    Eigen::Map<Eigen::Vector3d>{residuals} << pixel - o_.pixel,
        (1.0 / p.z() - o_.inverse_depth) / o_.inverse_depth_sigma;
    if (!jacobians || !jacobians[0]) return true;
    const double iz = 1.0 / p.z();
    Eigen::Matrix3d by_point;
    by_point << camera_.fx * iz, 0, -camera_.fx * p.x() * iz * iz, 0, camera_.fy * iz,
        -camera_.fy * p.y() * iz * iz, 0, 0, -iz * iz / o_.inverse_depth_sigma;
    Eigen::Map<Eigen::Matrix<double, 3, 6, Eigen::RowMajor>> j(jacobians[0]);
    j << by_point, -by_point * skew(p);
    return true;
  }

 private:
  const PoseObservation& o_;
  const Camera& camera_;
};

// One robust solve only; solve_pose does up to four, with outlier decisions between them.
void ceres_pose_500_points(benchmark::State& state) {
  const Camera camera;
  const std::vector<PoseObservation> observations = pose_observations(camera);
  for ([[maybe_unused]] auto _ : state) {
    std::array<double, 6> twist{};
    ceres::Problem problem;
    for (const PoseObservation& o : observations)
      problem.AddResidualBlock(new CeresPoseCost(o, camera), new ceres::HuberLoss(2.8),
                               twist.data());
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
    options.max_num_iterations = 6;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    benchmark::DoNotOptimize(twist);
  }
}
BENCHMARK(ceres_pose_500_points)->Unit(benchmark::kMicrosecond);

// Features all over the image, and queries for them that are `off` px beside.
struct Matching {
  Matching(int count, int queried, double off) {
    TestWorld random(0);
    for (int i = 0; i < count; ++i) {
      features.keypoints.emplace_back(static_cast<float>(random.uniform(19, 620)),
                                      static_cast<float>(random.uniform(19, 460)), 31.f, 0.f, 0.f,
                                      i % 8);
      features.descriptors.push_back(random.descriptor());
    }
    for (int i = 0; i < queried; ++i) {
      const std::size_t k = static_cast<std::size_t>(i % count);
      queries.push_back({.id = static_cast<std::uint32_t>(i),
                         .descriptor = random.flipped(features.descriptors[k], 20),
                         .u = features.keypoints[k].pt.x + off,
                         .v = features.keypoints[k].pt.y + off,
                         .radius = 15,
                         .min_level = i % 8 - 1,
                         .max_level = i % 8 + 1});
    }
  }
  Features features;
  std::vector<Query> queries;
};

void match_near_2000_queries(benchmark::State& state) {
  const Matching m(1000, 2000, 3.0);
  const FeatureGrid grid(m.features, Camera{});
  for ([[maybe_unused]] auto _ : state)
    benchmark::DoNotOptimize(match_near(m.queries, m.features, grid, all, {.ratio = 0.8}));
}
BENCHMARK(match_near_2000_queries)->Unit(benchmark::kMicrosecond);

void match_anywhere_1000_by_1000(benchmark::State& state) {
  const Matching m(1000, 1000, 0.0);
  for ([[maybe_unused]] auto _ : state)
    benchmark::DoNotOptimize(match_anywhere(m.queries, m.features, all, {.ratio = 0.8}));
}
BENCHMARK(match_anywhere_1000_by_1000)->Unit(benchmark::kMicrosecond);

void local_bundle_adjustment_15_keyframes(benchmark::State& state) {
  TestWorld world;
  std::vector<View> views;
  for (int i = 0; i < 15; ++i) views.push_back(world.render(walk(i)));
  MapEdit disturbed(known_map(world, views).map);
  for (KeyFrameId id = 1; id < 15; ++id) {
    Pose& pose = disturbed.keyframe(id).world_from_camera;
    pose = pose * pose_at({0.005, -0.005, 0.005}, {0.003, 0.002, -0.003});
  }
  const SparseMap map = std::move(disturbed).finish();
  for ([[maybe_unused]] auto _ : state) {
    MapEdit edit(map);
    benchmark::DoNotOptimize(
        adjust_locally(edit, 14, {.max_keyframes = 15, .max_iterations = 5}, {}));
  }
  state.counters["landmarks"] = static_cast<double>(map.landmark_count());
}
BENCHMARK(local_bundle_adjustment_15_keyframes)->Unit(benchmark::kMillisecond);

SparseMap map_of_20000_landmarks() {
  TestWorld world(2000);
  MapEdit edit{SparseMap{}};
  for (KeyFrameId id = 0; id < 50; ++id) {
    const View view = world.render(Pose::Identity());
    edit.add_keyframe(keyframe_of(view, id));
    for (std::uint32_t i = 0; i < 400; ++i)
      edit.add_observation(edit.add_landmark({.created_by = id}), {id, i});
  }
  return std::move(edit).finish();
}

void copy_map_of_20000_landmarks(benchmark::State& state) {
  const SparseMap map = map_of_20000_landmarks();
  for ([[maybe_unused]] auto _ : state) {
    SparseMap copy = map;
    benchmark::DoNotOptimize(copy);
  }
}
BENCHMARK(copy_map_of_20000_landmarks)->Unit(benchmark::kMicrosecond);

void edit_3000_landmarks_of_a_copy(benchmark::State& state) {
  const SparseMap map = map_of_20000_landmarks();
  for ([[maybe_unused]] auto _ : state) {
    MapEdit edit(map);
    for (LandmarkId id = 0; id < 3000; ++id) edit.landmark(id).position_in_world.x() += 0.001;
    benchmark::DoNotOptimize(std::move(edit).finish());
  }
}
BENCHMARK(edit_3000_landmarks_of_a_copy)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace stillpoint::orb_slam
