// Loop closer `orb`: removes drift when the camera returns (DS-SLAM III-A; ORB-SLAM, section VII).
#pragma once

#include <optional>
#include <vector>

#include "orb_slam/bundle_adjustment.hpp"
#include "orb_slam/loop_candidates.hpp"
#include "orb_slam/loop_match.hpp"
#include "orb_slam/pose_graph.hpp"
#include "stillpoint/contracts/loop_closer.hpp"
#include "stillpoint/options.hpp"
#include "stillpoint/plugin.hpp"

namespace stillpoint::orb_slam {

class OrbLoopCloser final : public LoopCloser {
 public:
  struct Options {
    int min_keyframes_between = 10;
    double max_drift = 0.05;
    int adjust_iterations = 10;

    void visit(OptionVisitor& visitor);
  };

  OrbLoopCloser(Options options, const StageContext& context);

  std::optional<MapCorrection> close(const SparseMap& map, KeyFrameId latest,
                                     std::stop_token stop) override;
  std::optional<MapCorrection> adjust(const SparseMap& map, std::stop_token end_early) override;

 private:
  std::optional<MapCorrection> correct(const SparseMap& map, const LoopMatch& loop,
                                       std::stop_token stop);

  Options options_;
  LoopCandidates candidates_;
  std::vector<PoseEdge> loops_;          // closed so far
  std::optional<KeyFrameId> last_loop_;  // the newest key frame of the last one
};

}  // namespace stillpoint::orb_slam
