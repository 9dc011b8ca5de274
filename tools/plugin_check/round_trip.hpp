// A place seen again, for loop closers: a camera that turns once around and a little farther, and
// drifts on the way.
#pragma once

#include <memory>
#include <random>
#include <vector>

#include "stillpoint/contracts/sparse_map.hpp"

namespace stillpoint::plugin_check {

/// Gives key frames with ORB-like features and with landmarks, one after the other, as they are
/// after local mapping. What has been out of sight for half a turn is not recognised: it becomes
/// new landmarks.
class RoundTrip {
 public:
  static constexpr int kKeyFrames = 44;
  static constexpr int kPerTurn = 36;  ///< key frames until the camera looks where it looked first

  RoundTrip();

  bool is_over() const { return next_ == kKeyFrames; }
  /// The key frame that came last, counted from 0.
  std::uint32_t newest() const { return static_cast<std::uint32_t>(next_ - 1); }
  /// `map`, empty at first, with the next key frame. Its pose is that of the one before, as it is
  /// in `map`, and the drift from there.
  SparseMap with_next(SparseMap map);
  /// Metres by which the newest key frame lies off the truth, seen from the first.
  double error(const SparseMap& map) const;

 private:
  struct Point {
    Eigen::Vector3d in_world;  // metres
    Descriptor descriptor;
    double angle;         // degrees, of its texture
    double max_distance;  // metres, from which it appears on pyramid level 0
    LandmarkId landmark = kNoId;
    int last_seen = 0;  // key frame
  };

  /// What the camera sees at a key frame, and the points that its features are of.
  KeyFrame view(int now, std::vector<Point*>& seen);
  Landmark landmark_of(const KeyFrame& keyframe, std::uint32_t feature,
                       const Eigen::Vector3d& in_camera) const;
  /// With some bits flipped.
  Descriptor seen_as(Descriptor descriptor);
  Descriptor random_descriptor() { return {random_(), random_(), random_(), random_()}; }
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  double normal() { return std::normal_distribution<double>()(random_); }

  std::mt19937_64 random_{3};
  std::shared_ptr<const Camera> camera_ = std::make_shared<const Camera>();
  std::vector<Point> points_;
  int next_ = 0;
};

}  // namespace stillpoint::plugin_check
