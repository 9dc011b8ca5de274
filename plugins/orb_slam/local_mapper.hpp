// Local mapper `orb`: extends and refines the sparse map (DS-SLAM III-A; ORB-SLAM2).
#pragma once

#include <vector>

#include "orb_slam/bundle_adjustment.hpp"
#include "stillpoint/contracts/local_mapper.hpp"
#include "stillpoint/options.hpp"
#include "stillpoint/plugin.hpp"

namespace stillpoint::orb_slam {

class OrbLocalMapper final : public LocalMapper {
 public:
  struct Options {
    int neighbours = 10;
    double redundant_share = 0.9;
    int bundle_keyframes = 10;
    int bundle_iterations = 5;

    void visit(OptionVisitor& visitor);
  };

  OrbLocalMapper(Options options, const StageContext& context);

  SparseMap insert(SparseMap map, KeyFrame keyframe) override;
  SparseMap refine(SparseMap map, KeyFrameId keyframe, std::stop_token end_early) override;

 private:
  void remember(const std::vector<LandmarkId>& created);

  Options options_;
  BundleOptions bundle_;
  std::vector<LandmarkId> recent_;  // landmarks that culling still checks
};

}  // namespace stillpoint::orb_slam
