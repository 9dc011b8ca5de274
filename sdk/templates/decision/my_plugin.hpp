// Decision `my_plugin`: objects of some classes are not mapped, and not used for tracking while
// they move.
#pragma once

#include <array>
#include <stillpoint/sdk.hpp>
#include <string>
#include <vector>

namespace plugins::my_plugin {

class MyPlugin final : public stillpoint::Decision {
 public:
  struct Options {
    std::vector<std::string> labels = {"person"};
    int min_moving_points = 3;
    int reach = 8;

    void visit(stillpoint::OptionVisitor& v) {
      v("labels", labels, {.help = "classes that can move"});
      v("min_moving_points", min_moving_points, {.min = 1, .help = "on an object that moves"});
      v("reach", reach,
        {.min = 0, .max = 100, .unit = "px", .help = "around moving points that is not used"});
    }
  };

  /// Throws Error(kUsage) for a label that the segmenter does not have.
  MyPlugin(Options options, const stillpoint::StageContext& context);

  stillpoint::StaticWeights decide(const stillpoint::Frame& frame,
                                   const stillpoint::Segmentation& segmentation,
                                   const stillpoint::MovingPoints& moving,
                                   const stillpoint::MapEvidence& evidence) override;

 private:
  bool moves(const cv::Mat& mask, const stillpoint::MovingPoints& moving) const;

  Options options_;
  std::array<bool, 256> can_move_{};  // by class id
};

}  // namespace plugins::my_plugin
