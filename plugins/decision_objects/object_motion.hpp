// Recursive Bayes filter of whether each object moves.
#pragma once

#include <map>
#include <vector>

#include "stillpoint/contracts/moving_points.hpp"
#include "stillpoint/contracts/segmentation.hpp"
#include "stillpoint/options.hpp"

namespace stillpoint::decision_objects {

struct ObjectMotionOptions {
  double gain = 15.0;         ///< log-odds per share of moving points above or below `share`
  double share = 0.1;         ///< of moving points on an object, neutral evidence
  double max_increase = 1.5;  ///< log-odds per frame, most
  double max_decrease = 0.3;  ///< log-odds per frame, most: people who pause go on walking
  double prior_decay = 0.02;  ///< decay towards the prior, per frame, seen or missed
  double max_log_odds = 3.5;  ///< greatest deviation from the prior
  int min_points = 4;         ///< on an object, for evidence
  double moves_above = 0.7;   ///< probability
  double static_below = 0.4;  ///< probability

  void visit(OptionVisitor& visitor);
};

/// The state of one object.
struct ObjectBelief {
  int label = 0;
  cv::Rect box;  ///< where it was last
  double prior = 0.0;
  double log_odds = 0.0;  ///< of moving
  bool moves = false;     ///< with hysteresis
  int updated = 0;        ///< number of the update that saw it last
};

/// How many of the checked points lie on an object.
struct PointCount {
  int points = 0;
  int moving = 0;
};

/// Follows objects by their id, or by overlap with the frame before where a stage gives none.
class ObjectBeliefs {
 public:
  explicit ObjectBeliefs(const ObjectMotionOptions& options) : options_(options) {}

  /// One belief per object, in the same order. `priors` are log-odds per object; counts are empty
  /// when the moving check was not reliable.
  const std::vector<ObjectBelief>& update(const std::vector<SegmentedObject>& objects,
                                          const std::vector<double>& priors,
                                          const std::vector<PointCount>& counts);

 private:
  const ObjectBelief* previous_belief(const SegmentedObject& object) const;
  void decay_to_prior(ObjectBelief& belief, int updates) const;
  void add_evidence(ObjectBelief& belief, const PointCount& count) const;

  ObjectMotionOptions options_;
  std::vector<ObjectBelief> latest_;
  std::map<int, ObjectBelief> by_id_;
  int updates_ = 0;
};

}  // namespace stillpoint::decision_objects
