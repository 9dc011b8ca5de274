#include "decision_objects/semantic_only.hpp"

#include "decision_objects/class_selection.hpp"
#include "decision_objects/weight_image.hpp"

namespace stillpoint::decision_objects {

void SemanticOnly::Options::visit(OptionVisitor& v) {
  v("labels", labels, {.help = "classes that are not used"});
  v("margin", margin,
    {.min = 0, .max = 50, .unit = "px", .help = "border around them that is excluded as well"});
}

SemanticOnly::SemanticOnly(const Options& options, const StageContext& context)
    : options_(options), labels_(select_classes(context.classes, options.labels)) {}

StaticWeights SemanticOnly::decide(const Frame& frame, const Segmentation& segmentation,
                                   const MovingPoints&, const MapEvidence&) {
  StaticWeights weights;
  for (std::size_t i = 0; i < segmentation.objects.size(); ++i) {
    const bool moves = labels_[static_cast<std::size_t>(segmentation.objects[i].label)];
    weights.object_moves.push_back(moves);
    if (!moves) continue;
    const ObjectMask mask = mask_of(segmentation, i, options_.margin);
    lower(weights.track, frame.gray.size(), mask, 0);
  }
  weights.map = weights.track;
  return weights;
}

}  // namespace stillpoint::decision_objects
