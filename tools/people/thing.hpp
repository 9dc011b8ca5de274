// A box that is put down or taken away.
#pragma once

#include <array>

#include "people/layer.hpp"
#include "people/view.hpp"
#include "people/walk.hpp"

namespace stillpoint::people {

class Thing {
 public:
  /// `sides`: what is printed on its sides and its top, CV_8UC3.
  Thing(ThingPlan plan, std::array<cv::Mat, 3> sides, double lower);

  /// As Figure::seen_from.
  Layer seen_from(const Pose& level_from_camera, const Rays& rays, double time) const;

 private:
  ThingPlan plan_;
  std::array<cv::Mat, 3> sides_;  // CV_32FC3, seen along its x, y and z
  double lower_;
};

}  // namespace stillpoint::people
