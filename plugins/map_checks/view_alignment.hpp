// The pose of a depth image among earlier views, by their surfaces.
#pragma once

#include <optional>
#include <span>

#include "map_checks/view_memory.hpp"

namespace stillpoint::map_checks {

/// Where a depth image lies among the views.
struct ViewAlignment {
  Pose world_from_camera = Pose::Identity();
  double agreement =
      0.0;  ///< of the points on and behind trusted surfaces, share that lies on them
};

/// The guess that agrees best with the trusted surfaces of the views, moved by point-to-plane ICP
/// with projective association (Newcombe et al., KinectFusion, ISMAR 2011). What has come in is an
/// outlier: however much of the image it fills, it lies on no surface that was seen before. Where
/// the surfaces leave the pose open, the guess holds. `views` must not be empty.
ViewAlignment align(const cv::Mat& depth, const CellCamera& camera, std::span<const Pose> guesses,
                    std::span<const View* const> views);

}  // namespace stillpoint::map_checks
