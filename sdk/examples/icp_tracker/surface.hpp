// A depth image as a grid of points with normals, and how two of them are brought together.
#pragma once

#include <optional>
#include <stillpoint/sdk.hpp>
#include <vector>

/// Points of every `step`-th pixel in the camera, row by row.
class Surface {
 public:
  Surface(const stillpoint::Frame& frame, int step);

  struct Element {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();   ///< metres
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit length; zero: unknown, beside edges
    int u = 0, v = 0;                                  ///< px
    bool known() const { return !normal.isZero(); }
  };
  const std::vector<Element>& elements() const { return elements_; }
  /// What the camera sees at a point in its frame; null outside of the image and where nothing is
  /// known.
  const Element* seen_at(const Eigen::Vector3d& point_in_camera) const;

 private:
  stillpoint::Camera camera_;
  int step_, columns_, rows_;
  std::vector<Element> elements_;
};

struct Registration {
  stillpoint::Pose reference_from_current = stillpoint::Pose::Identity();
  double share = 0.0;  ///< of the current surface's elements that found a correspondence
  int correspondences = 0;
};

/// Point-to-plane ICP with projective correspondences (Chen and Medioni 1992; Newcombe et al.,
/// ISMAR 2011, III-E). `weights` as StaticWeights::track, of the current frame: what may move does
/// not count. Correspondences are nearer than `reach` metres. Nothing when too little is seen of
/// both.
std::optional<Registration> registered(const Surface& reference, const Surface& current,
                                       const cv::Mat& weights, const stillpoint::Pose& guess,
                                       double reach);
