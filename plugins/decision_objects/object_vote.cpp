#include "decision_objects/object_vote.hpp"

#include "decision_objects/class_selection.hpp"
#include "decision_objects/weight_image.hpp"

namespace stillpoint::decision_objects {

void ObjectVote::Options::visit(OptionVisitor& v) {
  v("labels", labels, {.help = "classes that can move; all else is taken for static"});
  v("min_moving_points", min_moving_points,
    {.min = 1, .help = "an object with fewer does not move (the paper's 'certain number')"});
  v("min_moving_share", min_moving_share,
    {.min = 0, .max = 1, .help = "least share of moving points on an object that moves"});
  v("reach", reach,
    {.min = 0, .max = 100, .unit = "px", .help = "points this near to an object count as on it"});
  v("margin", margin,
    {.min = 0,
     .max = 50,
     .unit = "px",
     .help = "border around moving objects that is excluded as well"});
  v.choice(
      "unsure", unsure, {{"static", Unsure::kStatic}, {"moves", Unsure::kMoves}},
      {.help =
           "what objects of these classes are taken for while the moving check is not reliable"});
}

ObjectVote::ObjectVote(const Options& options, const StageContext& context)
    : options_(options), labels_(select_classes(context.classes, options.labels)) {}

StaticWeights ObjectVote::decide(const Frame& frame, const Segmentation& segmentation,
                                 const MovingPoints& moving, const MapEvidence&) {
  StaticWeights weights;
  for (std::size_t i = 0; i < segmentation.objects.size(); ++i) {
    weights.object_moves.push_back(moves(segmentation, i, moving));
    if (!weights.object_moves.back()) continue;
    lower(weights.track, frame.gray.size(), mask_of(segmentation, i, options_.margin), 0);
  }
  weights.map = weights.track;
  return weights;
}

bool ObjectVote::moves(const Segmentation& segmentation, std::size_t object,
                       const MovingPoints& moving) const {
  if (!labels_[static_cast<std::size_t>(segmentation.objects[object].label)]) return false;
  if (!moving.reliable) return options_.unsure == Unsure::kMoves;
  const ObjectMask mask = mask_of(segmentation, object, options_.reach);
  int points = 0, moved = 0;
  for (const PointMotion& point : moving.points) {
    const cv::Point pixel = point.current;
    if (!mask.box.contains(pixel) || mask.mask.at<std::uint8_t>(pixel - mask.box.tl()) == 0)
      continue;
    ++points;
    moved += point.moving ? 1 : 0;
  }
  return moved >= options_.min_moving_points && moved >= options_.min_moving_share * points;
}

}  // namespace stillpoint::decision_objects
