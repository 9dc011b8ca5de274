#include "motion_filter.hpp"

#include <algorithm>
#include <cmath>

namespace {

constexpr double kMemory = 2.0;      // s, after which an object that is out of view is a new one
constexpr double kMinOverlap = 0.3;  // intersection over union

double overlap(const cv::Rect& a, const cv::Rect& b) {
  const int common = (a & b).area();
  return common == 0 ? 0.0 : static_cast<double>(common) / (a.area() + b.area() - common);
}

}  // namespace

void FilterOptions::visit(stillpoint::OptionVisitor& v) {
  v("time_to_moving", time_to_moving,
    {.min = 0.001, .unit = "s", .help = "time constant of votes for moving"});
  v("time_to_static", time_to_static,
    {.min = 0.001,
     .unit = "s",
     .help = "of votes for standing still; longer: people who pause go on"});
  v("moves_above", moves_above,
    {.min = 0, .max = 1, .help = "filtered vote from which an object is not used"});
  v("static_below", static_below,
    {.min = 0, .max = 1, .help = "filtered vote below which it is used again"});
  v.require(static_below <= moves_above, "static_below is greater than moves_above");
}

const ObjectState& MotionFilter::update(const stillpoint::SegmentedObject& object, double time,
                                        double prior, Vote vote) {
  ObjectState* state = known(object);
  if (state == nullptr)
    state = &states_.emplace_back(
        ObjectState{.time = time, .vote = prior, .moves = prior > options_.moves_above});
  const double goal = vote.value_or(prior);
  const double time_constant =
      goal > state->vote ? options_.time_to_moving : options_.time_to_static;
  state->vote += (1 - std::exp((state->time - time) / time_constant)) * (goal - state->vote);
  state->moves = state->vote > (state->moves ? options_.static_below : options_.moves_above);
  state->id = object.id;
  state->label = object.label;
  state->box = object.box;
  state->time = time;
  return *state;
}

void MotionFilter::forget(double time) {
  std::erase_if(states_, [&](const ObjectState& state) { return time - state.time > kMemory; });
}

ObjectState* MotionFilter::known(const stillpoint::SegmentedObject& object) {
  const auto likeness = [&](const ObjectState& state) {
    if (object.id >= 0) return state.id == object.id ? 1.0 : 0.0;
    return state.label == object.label ? overlap(state.box, object.box) : 0.0;
  };
  const auto best = std::ranges::max_element(states_, {}, likeness);
  return best != states_.end() && likeness(*best) > kMinOverlap ? &*best : nullptr;
}
