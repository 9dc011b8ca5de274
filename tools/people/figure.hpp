// A cut-out person in the world: an upright picture turned to the camera, with some relief, that
// nowhere moves as a rigid body does.
#pragma once

#include <vector>

#include "people/cut_out.hpp"
#include "people/layer.hpp"
#include "people/view.hpp"
#include "people/walk.hpp"

namespace stillpoint::people {

class Figure {
 public:
  /// `lower`: metres by which the floor lies lower than that of the level frame.
  Figure(PersonPlan plan, CutOut cut, double lower, int seed);

  /// `time`: seconds from the first frame. Who is nearer than 0.3 m, or behind the camera, is left
  /// out: an empty box.
  Layer seen_from(const Pose& level_from_camera, const Rays& rays, double time) const;
  /// The same without colours.
  Layer shape_from(const Pose& level_from_camera, const Rays& rays, double time) const;

  const CutOut& cut() const { return levels_.front(); }
  /// Multiplies all colours.
  void relight(const cv::Scalar& gain);

 private:
  struct Board;
  struct Swing;
  struct Traced;
  Traced trace(const Pose& level_from_camera, const Rays& rays, double time) const;
  Layer shape_of(const Traced& traced) const;
  const CutOut& level_for(double distance, double focal) const;
  cv::Rect rough_box(const Board& board, const Rays& rays) const;
  Board board_at(const Pose& level_from_camera, const Stance& stance, double time) const;
  Swing swing_at(const Stance& stance, double time) const;

  PersonPlan plan_;
  std::vector<CutOut> levels_;
  double lower_;
  double rhythm_;  // rad, so that two people do not swing together
};

}  // namespace stillpoint::people
