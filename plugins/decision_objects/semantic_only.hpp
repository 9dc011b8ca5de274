// Decision `semantic_only`: whatever belongs to the listed classes is not used.
#pragma once

#include <bitset>

#include "stillpoint/contracts/decision.hpp"
#include "stillpoint/plugin.hpp"

namespace stillpoint::decision_objects {

class SemanticOnly final : public Decision {
 public:
  struct Options {
    std::vector<std::string> labels = {"person"};
    int margin = 5;

    void visit(OptionVisitor& visitor);
  };

  /// Throws Error(kUsage) as select_classes does.
  SemanticOnly(const Options& options, const StageContext& context);

  StaticWeights decide(const Frame& frame, const Segmentation& segmentation,
                       const MovingPoints& moving, const MapEvidence& evidence) override;

 private:
  Options options_;
  std::bitset<256> labels_;
};

}  // namespace stillpoint::decision_objects
