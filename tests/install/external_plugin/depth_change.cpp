// The example of docs/plugins/moving_checker.md: for a camera that stands still, whatever comes
// closer moves.
#include <stillpoint/sdk.hpp>

namespace {

class DepthChange final : public stillpoint::MovingChecker {
 public:
  struct Options {
    double threshold = 0.1;
    int spacing = 8;
    void visit(stillpoint::OptionVisitor& v) {
      v("threshold", threshold, {.min = 0, .unit = "m", .help = "coming closer by more is moving"});
      v("spacing", spacing, {.min = 1, .unit = "px", .help = "distance between checked points"});
    }
  };
  explicit DepthChange(Options options) : options_(options) {}

  stillpoint::MovingPoints check(const stillpoint::Frame& previous,
                                 const stillpoint::Frame& current,
                                 const stillpoint::TrackingHistory&) override {
    stillpoint::MovingPoints result;
    for (int y = 0; y < current.depth.rows; y += options_.spacing) {
      for (int x = 0; x < current.depth.cols; x += options_.spacing) {
        const float before = previous.depth.at<float>(y, x), now = current.depth.at<float>(y, x);
        if (before == 0 || now == 0) continue;  // not measured
        const cv::Point2f point(static_cast<float>(x), static_cast<float>(y));
        result.points.push_back({point, point, 0.0f, before - now > options_.threshold});
      }
    }
    result.reliable = !result.points.empty();
    return result;
  }

 private:
  Options options_;
};

}  // namespace

STILLPOINT_PLUGIN(depth_change, "0.1.0",
                  stillpoint::provide<stillpoint::MovingChecker, DepthChange>(
                      "depth_change", "depth compared with the previous frame, camera at rest"));
