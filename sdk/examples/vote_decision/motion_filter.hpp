// Whether objects move, filtered over time.
#pragma once

#include <optional>
#include <stillpoint/sdk.hpp>
#include <vector>

/// What a witness says of an object: 0 it stands still … 1 it moves; nothing: an abstention.
using Vote = std::optional<double>;

struct FilterOptions {
  double time_to_moving = 0.1;  ///< s, time constant
  double time_to_static = 0.6;  ///< s, likewise; people who pause go on walking
  double moves_above = 0.6;     ///< of the filtered vote
  double static_below = 0.3;    ///< likewise; in between, it is as it was

  void visit(stillpoint::OptionVisitor& v);
};

struct ObjectState {
  int id = -1;
  int label = 0;
  cv::Rect box;     ///< px, where it was last
  double time = 0;  ///< s, when
  double vote = 0;  ///< filtered
  bool moves = false;
};

/// An exponential filter in time, so that its effect is the same at any frame rate, and hysteresis.
/// Objects are followed by their id, or by overlap where the segmentation gives none.
class MotionFilter {
 public:
  explicit MotionFilter(FilterOptions options) : options_(options) {}

  /// Once per object and frame, `time` in seconds. A new object begins with `prior`, and without
  /// votes it goes back to it.
  const ObjectState& update(const stillpoint::SegmentedObject& object, double time, double prior,
                            Vote vote);
  /// At the end of each frame: who has not been seen for some time is forgotten.
  void forget(double time);

 private:
  ObjectState* known(const stillpoint::SegmentedObject& object);

  FilterOptions options_;
  std::vector<ObjectState> states_;
};
