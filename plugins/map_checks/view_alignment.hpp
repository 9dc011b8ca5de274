// Registration of a depth image to the surfaces of earlier views.
#pragma once

#include <optional>
#include <span>

#include "map_checks/view_memory.hpp"

namespace stillpoint::map_checks {

/// The pose of a depth image, and how well it fits.
struct ViewAlignment {
  Pose world_from_camera = Pose::Identity();
  double agreement =
      0.0;  ///< of the points on and behind trusted surfaces, share that lies on them
};

/// The guess that agrees best with the trusted surfaces of the views, moved by point-to-plane ICP
/// with projective association (Newcombe et al., KinectFusion, ISMAR 2011). Dynamic objects are
/// outliers: however much of the image they fill, they lie on no earlier surface. In directions
/// that the surfaces do not constrain, a prior keeps the guess. `views` must not be empty.
ViewAlignment align(const cv::Mat& depth, const CellCamera& camera, std::span<const Pose> guesses,
                    std::span<const View* const> views);

/// Where the static part of a view's depth fits the others, in the frame of the camera as it was
/// tracked. The depth image is taken some milliseconds before or after the colour image, and in a
/// fast motion tracking is off by centimetres: views that do not fit each other would give
/// free-space violations on what is static. Identity where the agreement is below `min_agreement`.
/// `others` must not be empty.
Pose tracked_from_depth(const View& view, std::span<const View* const> others,
                        double min_agreement);

}  // namespace stillpoint::map_checks
