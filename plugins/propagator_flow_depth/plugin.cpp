#include "propagator_flow_depth/flow_depth_propagator.hpp"

STILLPOINT_PLUGIN(propagator_flow_depth, "0.1.0",
                  stillpoint::provide<stillpoint::Propagator,
                                      stillpoint::propagator_flow_depth::FlowDepthPropagator>(
                      "flow_depth", "objects followed by optical flow and by their depth"));
