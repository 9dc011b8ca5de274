// Decision `geometry_only`: moving points and the surfaces around them, without any labels.
#pragma once

#include "decision_objects/motion_field.hpp"
#include "stillpoint/contracts/decision.hpp"

namespace stillpoint::decision_objects {

class GeometryOnly final : public Decision {
 public:
  struct Options {
    MotionFieldOptions field;
    double moves_above = 0.6;

    void visit(OptionVisitor& visitor);
  };

  explicit GeometryOnly(const Options& options) : options_(options), field_(options.field) {}

  StaticWeights decide(const Frame& frame, const Segmentation& segmentation,
                       const MovingPoints& moving, const MapEvidence& evidence) override;

 private:
  Options options_;
  MotionField field_;
};

}  // namespace stillpoint::decision_objects
