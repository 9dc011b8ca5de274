// Which way of fusing labels in a voxel is right most often: ours, a vote by majority, or counting
// all classes.
//   class_fusion_accuracy TRUTH RECORDING...
// TRUTH as for dense_map_accuracy. Every fifteenth frame of the recordings, at its true pose;
// labels with the errors of a network: objects missed, outlines off by up to 2 px.
#include <array>
#include <iostream>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "benchmarks/voxel_truth.hpp"
#include "segmenter_label_images/label_image_segmenter.hpp"
#include "semantic_octree/class_belief.hpp"
#include "semantic_octree/scan_bricks.hpp"
#include "stillpoint/support/majority_vote.hpp"

namespace stillpoint {
namespace {

using segmenter_label_images::LabelImageSegmenter;
using semantic_octree::ClassBelief;
using semantic_octree::ScanBrick;
using semantic_octree::ScanBricks;
using semantic_octree::VoxelObservation;

constexpr int kEvery = 15, kEveryOfTruth = 5;
constexpr int kKeyOfZero = 32768;

struct Fused {
  ClassBelief belief;
  MajorityVote vote;
  std::map<std::uint8_t, int> counts;
};
using Voxels = std::unordered_map<Key, Fused, KeyHash>;

Key key_in(const ScanBrick& brick, unsigned code) {
  Key key{};
  for (unsigned axis = 0; axis < 3; ++axis) {
    key[axis] = 8 * brick.key[axis] - kKeyOfZero;
    for (unsigned bit = 0; bit < 3; ++bit)
      key[axis] += static_cast<int>((code >> (3 * bit + axis) & 1U) << bit);
  }
  return key;
}

void fuse(Voxels& voxels, const ScanBricks& scan) {
  for (const ScanBrick* brick : scan.bricks()) {
    const VoxelObservation* observation = scan.observations(*brick);
    for (unsigned code = 0; code < ScanBrick::kVoxels; ++code) {
      if (!(brick->hit[code / 64] >> (code % 64) & 1U)) continue;
      Fused& fused = voxels[key_in(*brick, code)];
      fused.belief.add(observation->label);
      fused.vote.add(observation->label);
      ++fused.counts[observation->label];
      ++observation;
    }
  }
}

Voxels fused(const std::filesystem::path& recording, double edge, double miss_rate) {
  LabelImageSegmenter::Options options;
  options.path = recording / "labels";
  options.errors.miss_rate = miss_rate;
  options.errors.outline_error = 2;
  LabelImageSegmenter segmenter(options, StageContext{});
  ScanBricks scan({.resolution = edge, .range = kRange, .carve = false});
  Voxels voxels;
  for (const auto& [seen, labels, instances] : read_labelled_frames(recording, kEvery)) {
    auto frame = std::make_shared<Frame>(*seen.frame);
    cv::cvtColor(frame->gray, frame->bgr, cv::COLOR_GRAY2BGR);
    auto weights = std::make_shared<StaticWeights>();
    weights->map = labels != kPerson;
    scan.scan({.frame = frame,
               .segmentation = std::make_shared<Segmentation>(segmenter.segment(*frame)),
               .weights = weights,
               .world_from_camera = seen.world_from_camera});
    fuse(voxels, scan);
  }
  return voxels;
}

/// Accuracy and mean intersection over union of one way.
class Score {
 public:
  void add(std::uint8_t said, std::uint8_t real) {
    ++all_;
    right_ += said == real;
    both_[real] += said == real;
    ++said_[said];
    ++real_[real];
  }
  void print(const std::string& name) const {
    double iou = 0, kinds = 0;
    for (std::size_t i = 0; i < real_.size(); ++i) {
      if (real_[i] == 0) continue;
      ++kinds;
      iou += both_[i] / (said_[i] + real_[i] - both_[i]);
    }
    std::cout << "  " << name << ": accuracy " << right_ / all_ << ", mean IoU " << iou / kinds
              << '\n';
  }

 private:
  double all_ = 0, right_ = 0;
  std::array<double, 256> both_{}, said_{}, real_{};
};

void run(const std::vector<std::filesystem::path>& folders) {
  for (const double edge : {0.05, 0.02}) {
    const Truth truth =
        truth_in(read_labelled_frames(folders[0], kEveryOfTruth), Pose::Identity(), edge);
    for (std::size_t i = 1; i < folders.size(); ++i)
      for (const double miss_rate : {0.1, 0.3, 0.45}) {
        Score belief, vote, counts;
        for (const auto& [key, voxel] : fused(folders[i], edge, miss_rate)) {
          const auto real = truth.still.find(key);
          if (real == truth.still.end()) continue;
          const std::uint8_t label = most_seen(real->second);
          belief.add(voxel.belief.best(), label);
          vote.add(voxel.vote.winner, label);
          counts.add(most_seen(voxel.counts), label);
        }
        std::cout << folders[i].string() << ", " << 100 * edge << " cm, " << 100 * miss_rate
                  << " % missed\n";
        belief.print("belief");
        vote.print("vote by majority");
        counts.print("all counts");
      }
  }
}

}  // namespace
}  // namespace stillpoint

int main(int argc, char** argv) {
  return stillpoint::run_on_folders(argc, argv, "class_fusion_accuracy TRUTH RECORDING...",
                                    stillpoint::run);
}
