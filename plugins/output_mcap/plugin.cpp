#include <stillpoint/sdk.hpp>

#include "output_mcap/mcap_output.hpp"

using stillpoint::Output;
using stillpoint::provide;

STILLPOINT_PLUGIN(output_mcap, "0.1.0",
                  provide<Output, stillpoint::output_mcap::McapOutput>(
                      "mcap", "run.mcap: poses and maps as messages of ROS 2, for Foxglove"));
