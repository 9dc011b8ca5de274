// Decision `bayes`: the probability over time that each object moves, from the prior of its class
// and its moving points; unlabelled moving objects are detected by their points.
#pragma once

#include <array>
#include <map>
#include <string>

#include "decision_objects/motion_field.hpp"
#include "decision_objects/object_motion.hpp"
#include "stillpoint/contracts/decision.hpp"
#include "stillpoint/plugin.hpp"

namespace stillpoint::decision_objects {

/// The prior of a class, and whether it is mapped.
struct ClassPolicy {
  enum class Map { kNever, kWhenStatic };
  double prior = 0.05;  ///< probability of moving
  Map map = Map::kWhenStatic;

  void visit(OptionVisitor& visitor);
};

/// Surfaces without a label, judged by single points.
struct SurfacePolicy {
  double prior = 0.05;  ///< probability that a surface without evidence moves
  MotionFieldOptions field;

  void visit(OptionVisitor& visitor);
};

class Bayes final : public Decision {
 public:
  struct Options {
    std::map<std::string, ClassPolicy> classes = {
        {"person", {.prior = 0.9, .map = ClassPolicy::Map::kNever}},
        {"cat", {.prior = 0.8, .map = ClassPolicy::Map::kNever}},
        {"dog", {.prior = 0.8, .map = ClassPolicy::Map::kNever}},
        {"chair", {.prior = 0.1}},
    };
    ClassPolicy other;
    ObjectMotionOptions objects;
    SurfacePolicy unlabelled;
    double contradiction = 5.0;
    double trusted_share = 0.3;
    double doubted_share = 0.6;
    int margin = 5;

    void visit(OptionVisitor& visitor);
  };

  /// Throws Error(kUsage) for a class that no network knows.
  Bayes(const Options& options, const StageContext& context);

  StaticWeights decide(const Frame& frame, const Segmentation& segmentation,
                       const MovingPoints& moving, const MapEvidence& evidence) override;

 private:
  const ClassPolicy& policy_of(const SegmentedObject& object) const;
  void weigh_surfaces(const Frame& frame, const cv::Mat& from_map, StaticWeights& weights) const;
  void weigh_objects(const Frame& frame, const Segmentation& segmentation,
                     const MovingPoints& moving, const cv::Mat& from_map, StaticWeights& weights);
  double trust_in(const Segmentation& segmentation) const;
  std::uint8_t weight_of(double log_odds) const;

  Options options_;
  std::array<ClassPolicy, 256> policies_;  // by class id
  ObjectBeliefs beliefs_;
  MotionField field_;
};

}  // namespace stillpoint::decision_objects
