// Tracker `my_plugin`: visual odometry with depth. ORB features are matched with those of the last
// key frame, and the rigid motion of their points is the pose.
#pragma once

#include <opencv2/features2d.hpp>
#include <stillpoint/sdk.hpp>
#include <vector>

namespace plugins::my_plugin {

class MyPlugin final : public stillpoint::Tracker {
 public:
  struct Options {
    int features = 1000;
    double pixel_noise = 1.0;
    int min_inliers = 20;
    double keyframe_share = 0.4;
    double keyframe_distance = 0.2;

    void visit(stillpoint::OptionVisitor& v);
  };

  MyPlugin(const Options& options, const stillpoint::StageContext& context);

  stillpoint::PreparedFramePtr prepare(stillpoint::FramePtr frame) override;
  stillpoint::TrackResult track(stillpoint::PreparedFramePtr prepared,
                                const stillpoint::StaticWeights& weights,
                                const stillpoint::SparseMap& map,
                                stillpoint::TrackHints hints) override;

 private:
  struct Registration;

  Registration registered(const stillpoint::Features& current, const stillpoint::Camera& camera,
                          const std::vector<std::uint8_t>& weights) const;
  void begin_keyframe(stillpoint::TrackResult& result, const stillpoint::Frame& frame,
                      stillpoint::FeaturesPtr features, const stillpoint::StaticWeights& weights,
                      stillpoint::TrackHints hints);
  stillpoint::Pose world_from_reference(const stillpoint::SparseMap& map) const;

  Options options_;
  std::uint64_t seed_;
  cv::Ptr<cv::ORB> orb_;
  // The last key frame; null before the first. Only features with depth and weight are matched.
  stillpoint::FeaturesPtr reference_;
  std::vector<std::uint8_t> reference_weights_;
  stillpoint::KeyFrameId reference_id_ = stillpoint::kNoId;
  int reference_inliers_ = 0;  // of the first frame tracked against it; 0: there is none yet
  stillpoint::Pose world_from_new_reference_ = stillpoint::Pose::Identity();
  stillpoint::Pose reference_from_last_ = stillpoint::Pose::Identity();
};

}  // namespace plugins::my_plugin
