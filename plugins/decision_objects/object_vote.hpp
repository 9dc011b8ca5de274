// Decision `object_vote`: an object with enough moving points on it moves (DS-SLAM III-D).
#pragma once

#include <bitset>

#include "stillpoint/contracts/decision.hpp"
#include "stillpoint/plugin.hpp"

namespace stillpoint::decision_objects {

/// The features of what moves are removed; people who stand still keep theirs.
class ObjectVote final : public Decision {
 public:
  enum class Unsure { kStatic, kMoves };
  struct Options {
    std::vector<std::string> labels = {"person"};
    int min_moving_points = 3;
    double min_moving_share = 0.1;
    int reach = 0;   // px
    int margin = 5;  // px
    Unsure unsure = Unsure::kMoves;

    void visit(OptionVisitor& visitor);
  };

  /// Throws Error(kUsage) as select_classes does.
  ObjectVote(const Options& options, const StageContext& context);

  StaticWeights decide(const Frame& frame, const Segmentation& segmentation,
                       const MovingPoints& moving, const MapEvidence& evidence) override;

 private:
  bool moves(const Segmentation& segmentation, std::size_t object,
             const MovingPoints& moving) const;

  Options options_;
  std::bitset<256> labels_;
};

}  // namespace stillpoint::decision_objects
