#include "decision_objects/geometry_only.hpp"

#include <opencv2/imgproc.hpp>

#include "decision_objects/probability.hpp"

namespace stillpoint::decision_objects {

void GeometryOnly::Options::visit(OptionVisitor& v) {
  field.visit(v);
  v("moves_above", moves_above,
    {.min = 0.01, .max = 0.99, .help = "probability of moving from which a surface is not used"});
}

StaticWeights GeometryOnly::decide(const Frame& frame, const Segmentation&,
                                   const MovingPoints& moving, const MapEvidence&) {
  field_.update(frame, moving);
  const cv::Mat still = field_.log_odds() <= log_odds(options_.moves_above);
  StaticWeights weights;
  cv::resize(still, weights.track, frame.gray.size(), 0, 0, cv::INTER_NEAREST);
  weights.map = weights.track;
  return weights;
}

}  // namespace stillpoint::decision_objects
