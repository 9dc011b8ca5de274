// The light of a photograph and that of a scene.
#pragma once

#include <opencv2/core.hpp>

#include "people/cut_out.hpp"
#include "people/layer.hpp"

namespace stillpoint::people {

/// Sum and number of the pixels around somebody: what light they stand in.
struct Surroundings {
  cv::Scalar sum = cv::Scalar::all(0);
  double count = 0;

  void add(const Layer& layer, const cv::Mat& bgr);
};

/// What a person's colours are multiplied with to belong there. Brightness and colour of a
/// background are only in part those of the lamps, so neither is taken over in full, and bright
/// clothes are not washed out.
cv::Scalar gain_for(const Surroundings& surroundings, const CutOut& person);

}  // namespace stillpoint::people
