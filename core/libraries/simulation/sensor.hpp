// What a Kinect makes of a perfect view: noise, quantisation, shadows and holes in depth; noise and
// changing brightness in colour.
#pragma once

#include "simulation/renderer.hpp"

namespace stillpoint::simulation {

class Sensor {
 public:
  Sensor(const SensorOptions& options, int seed, double depth_factor, int threads)
      : options_(options),
        seed_(static_cast<std::uint32_t>(seed)),
        depth_factor_(depth_factor),
        threads_(threads) {}

  /// CV_8UC3, BGR. `time` in seconds from the first frame.
  cv::Mat color_image(const View& view, int frame, double time) const;
  /// CV_16UC1 in units of 1 / depth_factor metres, 0 = no measurement.
  cv::Mat depth_image(const View& view, int frame) const;

 private:
  float gain(double time) const;
  /// Distances of what the projector's light comes back from, metres.
  std::vector<float> seen_row(const View& view, int frame, int y) const;
  void measure_row(const View& view, int frame, int y, std::uint16_t* depth) const;

  SensorOptions options_;
  std::uint32_t seed_;
  double depth_factor_;
  int threads_;
};

}  // namespace stillpoint::simulation
