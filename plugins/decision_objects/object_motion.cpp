#include "decision_objects/object_motion.hpp"

#include <algorithm>
#include <cmath>

#include "decision_objects/probability.hpp"

namespace stillpoint::decision_objects {

void ObjectMotionOptions::visit(OptionVisitor& v) {
  v("gain", gain,
    {.min = 0,
     .max = 1000,
     .unit = "log-odds",
     .help = "evidence of an object in a frame: gain * (its share of moving points - share)"});
  v("share", share,
    {.min = 0,
     .max = 1,
     .help = "share of moving points that says neither moving nor static: more is evidence for "
             "moving"});
  v("max_increase", max_increase,
    {.min = 0, .max = 100, .unit = "log-odds", .help = "largest increase per frame"});
  v("max_decrease", max_decrease,
    {.min = 0,
     .max = 100,
     .unit = "log-odds",
     .help = "largest decrease per frame; small, since people pause"});
  v("prior_decay", prior_decay,
    {.min = 0, .max = 1, .help = "decay towards the prior per frame, seen or missed"});
  v("max_log_odds", max_log_odds,
    {.min = 0, .max = 20, .unit = "log-odds", .help = "greatest deviation from the prior"});
  v("min_points", min_points, {.min = 1, .help = "points that an object needs for evidence"});
  v("moves_above", moves_above,
    {.min = 0.2,
     .max = 1,
     .help =
         "probability of moving from which an object is excluded; its weight falls until there"});
  v("static_below", static_below,
    {.min = 0, .max = 1, .help = "probability below which an excluded object is used again"});
  v.require(static_below <= moves_above, "static_below is greater than moves_above");
}

const std::vector<ObjectBelief>& ObjectBeliefs::update(const std::vector<SegmentedObject>& objects,
                                                       const std::vector<double>& priors,
                                                       const std::vector<PointCount>& counts) {
  constexpr int kMaxAge = 300;  // updates; ids are not used again
  ++updates_;
  std::erase_if(by_id_,
                [&](const auto& entry) { return updates_ - entry.second.updated > kMaxAge; });
  std::vector<ObjectBelief> beliefs;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const ObjectBelief* before = previous_belief(objects[i]);
    ObjectBelief belief =
        before ? *before : ObjectBelief{.log_odds = priors[i], .moves = priors[i] > 0};
    belief.label = objects[i].label;
    belief.box = objects[i].box;
    belief.prior = priors[i];
    decay_to_prior(belief, before ? updates_ - before->updated : 1);
    belief.updated = updates_;
    add_evidence(belief, counts.empty() ? PointCount{} : counts[i]);
    if (objects[i].id >= 0) by_id_[objects[i].id] = belief;
    beliefs.push_back(belief);
  }
  latest_ = std::move(beliefs);
  return latest_;
}

const ObjectBelief* ObjectBeliefs::previous_belief(const SegmentedObject& object) const {
  constexpr double kMinOverlap = 0.3;
  if (object.id >= 0) {
    const auto found = by_id_.find(object.id);
    return found == by_id_.end() ? nullptr : &found->second;
  }
  const ObjectBelief* best = nullptr;
  double best_overlap = kMinOverlap;
  for (const ObjectBelief& belief : latest_) {
    if (belief.label != object.label) continue;
    const double common = (belief.box & object.box).area();
    const double overlap = common / std::max(belief.box.area() + object.box.area() - common, 1.0);
    if (overlap <= best_overlap) continue;
    best = &belief;
    best_overlap = overlap;
  }
  return best;
}

void ObjectBeliefs::decay_to_prior(ObjectBelief& belief, int updates) const {
  const double kept = std::pow(1 - options_.prior_decay, updates);
  belief.log_odds = belief.prior + kept * (belief.log_odds - belief.prior);
}

void ObjectBeliefs::add_evidence(ObjectBelief& belief, const PointCount& count) const {
  if (count.points >= options_.min_points) {
    const double share = static_cast<double>(count.moving) / count.points;
    belief.log_odds += std::clamp(options_.gain * (share - options_.share), -options_.max_decrease,
                                  options_.max_increase);
  }
  belief.log_odds = std::clamp(belief.log_odds, belief.prior - options_.max_log_odds,
                               belief.prior + options_.max_log_odds);
  const double p = probability(belief.log_odds);
  belief.moves = belief.moves ? p > options_.static_below : p > options_.moves_above;
}

}  // namespace stillpoint::decision_objects
