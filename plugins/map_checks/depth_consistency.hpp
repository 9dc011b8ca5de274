// Map check `depth_consistency`: the depth image against the surfaces that earlier frames saw.
#pragma once

#include "map_checks/surface_evidence.hpp"
#include "map_checks/view_alignment.hpp"

namespace stillpoint::map_checks {

/// Depth in front of a surface that an earlier frame saw there is a free-space violation: an
/// object has come in. Depth on it, from another viewpoint or after a second, is static. Needs
/// neither labels nor a static majority of the image (after DynaSLAM's multi-view
/// geometry, Bescos et al., RA-L 2018, III-B).
class DepthConsistency final : public MapChecker {
 public:
  struct Options {
    MemoryOptions memory;
    SurfaceEvidenceOptions surface;
    double min_agreement = 0.5;

    void visit(OptionVisitor& visitor);
  };

  explicit DepthConsistency(const Options& options) : options_(options), memory_(options.memory) {}

  MapEvidence check(const Frame& frame, std::span<const Pose> guesses,
                    const SparseMap& map) override;
  void remember(const TrackedFrame& frame) override;
  void clear() override { memory_ = ViewMemory(options_.memory); }

 private:
  /// Those that have enough of the depth image in theirs, the one with most first.
  std::vector<const View*> overlapping_views(const cv::Mat& depth, const CellCamera& camera,
                                             const Pose& world_from_camera) const;

  Options options_;
  ViewMemory memory_;
};

}  // namespace stillpoint::map_checks
