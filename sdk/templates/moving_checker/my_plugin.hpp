// Moving checker `my_plugin`: corners followed by optical flow; what does not fit the camera's own
// motion moves.
#pragma once

#include <stillpoint/sdk.hpp>

namespace plugins::my_plugin {

class MyPlugin final : public stillpoint::MovingChecker {
 public:
  struct Options {
    double threshold = 2.0;
    int max_corners = 500;
    int min_inliers = 30;

    void visit(stillpoint::OptionVisitor& v) {
      v("threshold", threshold,
        {.min = 0.1, .unit = "px", .help = "farther than this from the prediction is moving"});
      v("max_corners", max_corners, {.min = 10, .max = 10000, .help = "points followed"});
      v("min_inliers", min_inliers,
        {.min = 3, .help = "points that fit the camera's motion; with fewer, nothing is known"});
    }
  };

  MyPlugin(Options options, const stillpoint::StageContext& context)
      : options_(options), seed_(context.seed) {}

  stillpoint::MovingPoints check(const stillpoint::Frame& previous,
                                 const stillpoint::Frame& current,
                                 const stillpoint::TrackingHistory& history) override;

 private:
  Options options_;
  std::uint64_t seed_;
};

}  // namespace plugins::my_plugin
