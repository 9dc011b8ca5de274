// Moving check from colour and depth: points that are outliers to the rigid motion of the camera.
#pragma once

#include <stillpoint/sdk.hpp>

#include <cstdint>
#include <vector>

#include "moving_checks/depth_surface.hpp"
#include "moving_checks/point_follower.hpp"
#include "stillpoint/support/rigid_motion.hpp"

namespace stillpoint::moving_checks {

/// `rgbd_reprojection`. Depth gives metric scale, so that pure rotation, planar scenes and a static
/// camera are not degenerate. Remembers from call to call which points were static: those decide
/// which of two motions is the camera's.
class RgbdChecker final : public MovingChecker {
 public:
  struct Options {
    double epsilon = 1.0;         ///< px
    double noise_multiple = 4.0;  ///< of the median residual of inliers
    double pixel_noise = 0.4;     ///< px
    SurfaceOptions surface;
    FollowOptions follow;
    int samples = 60;
    int min_matches = 20;
    double min_agreement = 0.4;
    double min_depth = 0.5;      ///< m, of points without depth
    double usual_depth = 2.0;    ///< m, of points without depth
    double max_ambiguity = 1.0;  ///< px

    void visit(OptionVisitor& v);
  };

  RgbdChecker(const Options& options, const StageContext& context)
      : options_(options), seed_(context.seed), follower_(options.follow) {}

  MovingPoints check(const Frame& previous, const Frame& current, const TrackingHistory&) override;

 private:
  // A match with the surfaces it lies on in both frames.
  struct Observation {
    Match match;
    Surface from, to;
    double trust = 0.5;           // 0 moving … 1 static so far
    bool is_predictable = false;  // accurately enough to classify it
  };
  // What was known of the last frame with enough matches.
  struct Memory {
    std::uint32_t frame = 0;
    double time = 0;  // seconds
    Pose motion = Pose::Identity();
    std::vector<cv::Point2f> points;
    std::vector<double> inverse_depth;  // 1/m, 0 = not measured
    std::vector<double> trust;
  };

  RigidNoise noise_of(const Camera& camera) const;
  Surface surface_in(const Frame& frame, const cv::Point2f& pixel) const;
  std::vector<Observation> observe(const Frame& previous, const Frame& current);
  double inherited_trust(const Observation& observation, double radius) const;
  std::optional<RigidMotion> camera_motion(const std::vector<Observation>& observations,
                                           const Frame& current) const;
  void classify(std::vector<Observation>& observations, const RigidMotion& motion,
                const Camera& camera, MovingPoints& result) const;
  void search_from_prediction(std::vector<Observation>& observations, const Pose& motion,
                              const Frame& current, MovingPoints& result) const;
  void remember(const std::vector<Observation>& observations, const MovingPoints& result,
                const Pose& motion, const Frame& frame);

  Options options_;
  std::uint64_t seed_;
  PointFollower follower_;
  Memory memory_;
};

}  // namespace stillpoint::moving_checks
