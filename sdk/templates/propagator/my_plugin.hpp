// Propagator `my_plugin`: moves each object by the median optical flow of its points.
#pragma once

#include <stillpoint/sdk.hpp>

namespace plugins::my_plugin {

class MyPlugin final : public stillpoint::Propagator {
 public:
  struct Options {
    int spacing = 8;
    int min_points = 5;

    void visit(stillpoint::OptionVisitor& v) {
      v("spacing", spacing, {.min = 1, .max = 64, .unit = "px", .help = "between points followed"});
      v("min_points", min_points,
        {.min = 1, .help = "objects with fewer points found again stay where they were"});
    }
  };

  explicit MyPlugin(Options options) : options_(options) {}

  stillpoint::Segmentation propagate(const stillpoint::Segmentation& segmentation,
                                     const stillpoint::Frame& from,
                                     const stillpoint::Frame& to) override;

 private:
  cv::Point motion_of(const cv::Mat& mask, const cv::Rect& box, const stillpoint::Frame& from,
                      const stillpoint::Frame& to) const;

  Options options_;
};

}  // namespace plugins::my_plugin
