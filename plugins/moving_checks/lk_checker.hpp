// Moving consistency check of the paper (III-C, Algorithm 1) and variants: optical flow against a
// model of the camera's motion, from the images alone.
#pragma once

#include <stillpoint/sdk.hpp>

#include "moving_checks/image_model.hpp"
#include "moving_checks/point_follower.hpp"

namespace stillpoint::moving_checks {

/// Options that the checks from images alone share: optical flow, and robust estimation.
struct LkOptions {
  ConsensusOptions consensus;
  FollowOptions follow;
  int min_matches = 30;
  double min_inlier_share = 0.5;

  void visit(OptionVisitor& v);
};

/// `lk_epipolar` as in the paper, plus tests of inliers and degeneracy;
/// `lk_usac` and `lk_magsac` find the fundamental matrix
/// with other estimators. Without parallax a fundamental matrix is not determined (camera that
/// stands still or only turns, a plane): `when_degenerate` says what happens then.
class EpipolarChecker : public MovingChecker {
 public:
  enum class Degenerate { kUnreliable, kHomography, kIgnore };

  struct Options {
    double epsilon = 1.0;  ///< px
    LkOptions lk;
    double min_parallax = 0.3;    ///< px
    double parallax_share = 0.2;  ///< of the inliers
    Degenerate when_degenerate = Degenerate::kUnreliable;

    void visit(OptionVisitor& v);
  };

  MovingPoints check(const Frame& previous, const Frame& current, const TrackingHistory&) override;

 protected:
  EpipolarChecker(const Options& options, Consensus consensus, const StageContext& context);

 private:
  Options options_;
  Consensus consensus_;
  int seed_;
  PointFollower follower_;
};

class LkEpipolar final : public EpipolarChecker {
 public:
  LkEpipolar(const Options& options, const StageContext& context)
      : EpipolarChecker(options, Consensus::kRansac, context) {}
};

class LkUsac final : public EpipolarChecker {
 public:
  LkUsac(const Options& options, const StageContext& context)
      : EpipolarChecker(options, Consensus::kUsac, context) {}
};

class LkMagsac final : public EpipolarChecker {
 public:
  LkMagsac(const Options& options, const StageContext& context)
      : EpipolarChecker(options, Consensus::kMagsac, context) {}
};

/// One homography for all static points: exact for a camera that only rotates or sees one plane;
/// parallax of near objects counts as motion.
class LkHomography final : public MovingChecker {
 public:
  struct Options {
    double epsilon = 2.0;  ///< px
    LkOptions lk;

    void visit(OptionVisitor& v);
  };

  explicit LkHomography(const Options& options) : options_(options), follower_(options.lk.follow) {}

  MovingPoints check(const Frame& previous, const Frame& current, const TrackingHistory&) override;

 private:
  Options options_;
  PointFollower follower_;
};

}  // namespace stillpoint::moving_checks
