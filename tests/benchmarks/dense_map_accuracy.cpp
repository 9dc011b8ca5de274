// How right a dense map is, against a recording's true poses and labels.
//   dense_map_accuracy TRUTH[,PEOPLE] RUN...
// TRUTH: the recording's twin without noise, `stillpoint simulate SCENE --set
// source.sensor.ideal=true` with the same seeds, and with labels. Where there is no such twin with
// people, PEOPLE is the recording itself and TRUTH the same without people (tools/real_people):
// what people were in, and what they have put down, is then PEOPLE's, the rest TRUTH's. RUN:
// folders of `stillpoint run` with map_backend octomap; their maps are laid onto the truth by the
// best alignment of their trajectories. One line of JSON each.
#include <algorithm>
#include <array>
#include <iostream>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <unordered_map>
#include <vector>

#include "benchmarks/voxel_truth.hpp"
#include "evaluation/evaluation.hpp"
#include "map_octomap/octomap_backend.hpp"
#include "semantic_octree/cost_map.hpp"
#include "semantic_octree/octree_reader.hpp"
#include "stillpoint/pose_math.hpp"

namespace stillpoint {
namespace {

using map_octomap::OctomapBackend;
using semantic_octree::CostMap;
using semantic_octree::floor_of;
using semantic_octree::for_each_occupied_voxel;
using semantic_octree::project;
using semantic_octree::read_octree;
using semantic_octree::SavedOctree;
using semantic_octree::SemanticOctree;
using semantic_octree::SemanticVoxel;

constexpr int kEvery = 5;  // frames of the truth

double ratio(double part, double whole) { return whole > 0 ? part / whole : 0; }

nlohmann::json judge(const SemanticOctree& tree, const Truth& truth) {
  std::unordered_map<Key, std::uint8_t, KeyHash> occupied;
  for_each_occupied_voxel(tree, [&](const Eigen::Vector3d& at, const SemanticVoxel& voxel) {
    occupied[key_of(at, tree.getResolution())] = voxel.classes().best();
  });
  std::size_t right = 0, ghosts = 0, found = 0, same_class = 0;
  std::array<std::array<double, 3>, 256> classes{};  // in both, in the map, in truth
  for (const auto& [key, label] : occupied) {
    const auto* real = near(truth.still, key);
    if (!real) {
      ghosts += near(truth.people, key) != nullptr;
      continue;
    }
    ++right;
    const std::uint8_t expected = most_seen(real->second);
    same_class += expected == label;
    if (expected == label) ++classes[label][0];
    ++classes[label][1];
    ++classes[expected][2];
  }
  for (const auto& [key, counts] : truth.still) found += near(occupied, key) != nullptr;
  double iou = 0;
  int kinds = 0;
  for (const auto& [both, mapped, real] : classes) {
    if (real == 0) continue;
    ++kinds;
    iou += both / (mapped + real - both);
  }
  const double precision = ratio(right, occupied.size()), recall = ratio(found, truth.still.size());
  return {{"occupied", occupied.size()},
          {"precision", precision},
          {"recall", recall},
          {"f_score", ratio(2 * precision * recall, precision + recall)},
          {"class_accuracy", ratio(same_class, right)},
          {"mean_iou", ratio(iou, kinds)},
          {"classes", kinds},
          {"ghosts", ghosts},
          {"ghosts_per_s", ratio(ghosts, truth.seconds)}};
}

// The map that exact images at exact poses give, without people.
std::unique_ptr<OctomapBackend> exact_map(const std::vector<LabelledFrame>& frames,
                                          const Pose& map_from_truth, double edge) {
  auto map = std::make_unique<OctomapBackend>(
      OctomapBackend::Options{.resolution = edge, .range = kRange, .margin = 0}, StageContext{});
  KeyFrameId id = 0;
  for (const auto& [seen, labels, instances] : frames) {
    auto frame = std::make_shared<Frame>(*seen.frame);
    cv::cvtColor(frame->gray, frame->bgr, cv::COLOR_GRAY2BGR);
    auto weights = std::make_shared<StaticWeights>();
    cv::dilate(labels == kPerson, weights->map, cv::Mat::ones(5, 5, CV_8U));
    weights->map = 255 - weights->map;
    map->integrate({.id = id++,
                    .frame = frame,
                    .weights = weights,
                    .world_from_camera = map_from_truth * seen.world_from_camera});
  }
  return map;
}

// As a planner sees it: cells that are wrongly in its way, and things it would run into.
nlohmann::json judge_cost_map(const SemanticOctree& tree, const SemanticOctree& exact,
                              const Truth& truth) {
  const auto floor = floor_of(exact, {});
  if (!floor) return nullptr;
  const CostMap ours = project(tree, *floor, {}), real = project(exact, *floor, {});
  cv::Mat shown(real.cells.size(), CV_8U, cv::Scalar(CostMap::kUnknown));  // ours on its cells
  const cv::Point shift(cvRound((ours.corner.x() - real.corner.x()) / real.resolution),
                        cvRound((real.corner.y() - ours.corner.y()) / real.resolution) +
                            real.cells.rows - ours.cells.rows);
  for (int y = 0; y < shown.rows; ++y)
    for (int x = 0; x < shown.cols; ++x) {
      const cv::Point at = cv::Point(x, y) - shift;
      if (cv::Rect({}, ours.cells.size()).contains(at))
        shown.at<std::uint8_t>(y, x) = ours.cells.at<std::uint8_t>(at);
    }
  cv::Mat walked = cv::Mat::zeros(shown.size(), CV_8U), near_real, near_ours;
  for (const auto& [key, count] : truth.people) {
    const Eigen::Vector3d at =
        real.resolution * (Eigen::Vector3d(key[0], key[1], key[2]).array() + 0.5).matrix();
    const cv::Point cell = real.cell_of(at);
    if (cv::Rect({}, walked.size()).contains(cell)) walked.at<std::uint8_t>(cell) = 255;
  }
  const cv::Mat window = cv::Mat::ones(3, 3, CV_8U);
  cv::dilate(real.cells == CostMap::kOccupied, near_real, window);
  cv::dilate(shown == CostMap::kOccupied, near_ours, window);
  const cv::Mat obstacle = shown == CostMap::kOccupied, thing = real.cells == CostMap::kOccupied;
  const cv::Mat false_obstacle = obstacle & ~near_real & (real.cells == CostMap::kFree);
  return {
      {"obstacles", cv::countNonZero(obstacle)},
      {"false", cv::countNonZero(false_obstacle)},
      {"false_where_people_walked", cv::countNonZero(false_obstacle & walked)},
      {"things", cv::countNonZero(thing)},
      {"missing", cv::countNonZero(thing & ~near_ours & (shown == CostMap::kFree))},
      {"holes", cv::countNonZero(thing & (shown == CostMap::kFree))},
      {"unseen", cv::countNonZero(thing & ~near_ours & (shown == CostMap::kUnknown))},
      {"free", cv::countNonZero(real.cells == CostMap::kFree)},
      {"free_found", cv::countNonZero((real.cells == CostMap::kFree) & (shown == CostMap::kFree))}};
}

// The mean over all poses: positions alone do not fix the rotation of a camera that hardly moves.
Pose map_from_truth_of(const std::filesystem::path& truth, const std::filesystem::path& run) {
  const auto result =
      evaluation::evaluate(evaluation::read_trajectory(truth / "groundtruth.txt"),
                           evaluation::read_trajectory(run / "trajectory.txt"), {}, {});
  Pose mean = Pose::Identity();
  mean.matrix().setZero();
  for (const auto& [real, estimated] : result.pairs)
    mean.matrix() += (result.estimate.poses[estimated].world_from_camera *
                      result.reference.poses[real].world_from_camera.inverse())
                         .matrix() /
                     static_cast<double>(result.pairs.size());
  return orthonormalised(mean);
}

void run(const std::vector<std::filesystem::path>& folders) {
  const std::string names = folders[0].string();
  const std::filesystem::path room = names.substr(0, names.find(','));
  const std::filesystem::path crowd =
      names.substr(names.find(',') + 1);  // the same without a comma
  const std::vector<LabelledFrame> frames = read_labelled_frames(room, kEvery);
  const std::vector<LabelledFrame> with_people = read_labelled_frames(crowd, kEvery);
  for (std::size_t i = 1; i < folders.size(); ++i) {
    const SavedOctree saved = read_octree(folders[i] / "map" / "map.ot");
    const Pose map_from_truth = map_from_truth_of(room, folders[i]);
    const double edge = saved.tree->getResolution();
    Truth truth = truth_in(frames, map_from_truth, edge);
    truth.people = truth_in(with_people, map_from_truth, edge).people;
    if (crowd != room) add_things(with_people, map_from_truth, edge, truth);
    nlohmann::json result = {{"run", folders[i].string()}};
    result.update(judge(*saved.tree, truth));
    result["cost_map"] =
        judge_cost_map(*saved.tree, exact_map(frames, map_from_truth, edge)->tree(), truth);
    std::cout << result.dump() << std::endl;
  }
}

}  // namespace
}  // namespace stillpoint

int main(int argc, char** argv) {
  return stillpoint::run_on_folders(argc, argv, "dense_map_accuracy TRUTH[,PEOPLE] RUN...",
                                    stillpoint::run);
}
