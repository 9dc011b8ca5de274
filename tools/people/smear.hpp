// How sharp a camera sees what is pasted.
#pragma once

#include "people/layer.hpp"
#include "people/view.hpp"

namespace stillpoint::people {

/// Blurs colours and outline by `blur` (px, standard deviation) and along the way on which the
/// camera's motion from the beginning to the end of the exposure moves the layer's middle.
void smear(Layer& layer, const Pose& camera_at_end_from_begin, const Rays& rays, double blur);

}  // namespace stillpoint::people
