// Moving checker `dense_flow`: dense optical flow, less the flow that the camera's own motion
// explains by depth.
#pragma once

#include <opencv2/video/tracking.hpp>
#include <optional>
#include <stillpoint/sdk.hpp>
#include <stillpoint/support/rigid_motion.hpp>
#include <vector>

class DenseFlowChecker final : public stillpoint::MovingChecker {
 public:
  /// OpenCV's presets of DIS.
  enum Quality {
    kUltraFast = cv::DISOpticalFlow::PRESET_ULTRAFAST,
    kFast = cv::DISOpticalFlow::PRESET_FAST,
    kMedium = cv::DISOpticalFlow::PRESET_MEDIUM
  };
  struct Options {
    double threshold = 1.5;  ///< px
    int spacing = 12;        ///< px
    int edge = 6;            ///< px
    double min_agreement = 0.4;
    Quality quality = kFast;

    void visit(stillpoint::OptionVisitor& v);
  };

  DenseFlowChecker(Options options, const stillpoint::StageContext& context)
      : options_(options),
        seed_(context.seed),
        flow_(cv::DISOpticalFlow::create(options.quality)) {}

  stillpoint::MovingPoints check(const stillpoint::Frame& previous,
                                 const stillpoint::Frame& current,
                                 const stillpoint::TrackingHistory& history) override;

 private:
  std::vector<stillpoint::Pose> likely_motions(const stillpoint::TrackingHistory& history);
  bool judge(stillpoint::PointMotion& point, const stillpoint::RigidMatch& match,
             const stillpoint::RigidMotion& motion, const stillpoint::Frame& previous,
             const stillpoint::Frame& current) const;

  Options options_;
  std::uint64_t seed_;
  cv::Ptr<cv::DISOpticalFlow> flow_;
  std::optional<stillpoint::Pose> world_from_earlier_;  // of the frame before the previous one
};
