#include <stillpoint/sdk.hpp>

#include "map_checks/depth_consistency.hpp"

using stillpoint::MapChecker;
using stillpoint::provide;

STILLPOINT_PLUGIN(
    map_checks, "0.1.0",
    provide<MapChecker, stillpoint::map_checks::DepthConsistency>(
        "depth_consistency",
        "depth against the surfaces that earlier frames saw, at their present poses"));
