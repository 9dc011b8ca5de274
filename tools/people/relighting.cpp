#include "people/relighting.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace stillpoint::people {

void Surroundings::add(const Layer& layer, const cv::Mat& bgr) {
  if (layer.box.empty()) return;
  const int margin = layer.box.width / 3 + 10;
  const cv::Rect around = cv::Rect(layer.box.tl() - cv::Point(margin, margin),
                                   layer.box.br() + cv::Point(margin, margin)) &
                          cv::Rect({}, bgr.size());
  const cv::Mat outside = layer.alpha(around) < 0.1;
  const int pixels = cv::countNonZero(outside);
  sum += cv::mean(bgr(around), outside) * pixels;
  count += pixels;
}

cv::Scalar gain_for(const Surroundings& surroundings, const CutOut& person) {
  constexpr double kTaken = 0.4;      // exponent
  constexpr double kBrightest = 225;  // that highlights become
  if (surroundings.count == 0) return cv::Scalar::all(1);
  cv::Scalar gain;
  for (int c = 0; c < 3; ++c) {
    const double there = std::max(10.0, surroundings.sum[c] / surroundings.count);
    gain[c] = std::clamp(std::pow(there / std::max(10.0, person.light[c]), kTaken), 0.6, 1.3);
  }
  const double mean = (gain[0] + gain[1] + gain[2]) / 3;
  return gain * std::min(1.0, kBrightest / std::max(1.0, mean * person.highlights));
}

}  // namespace stillpoint::people
