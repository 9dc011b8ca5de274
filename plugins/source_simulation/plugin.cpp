#include <stillpoint/sdk.hpp>

#include "source_simulation/simulation_source.hpp"

STILLPOINT_PLUGIN(
    source_simulation, "0.1.0",
    stillpoint::provide<stillpoint::Source, stillpoint::source_simulation::SimulationSource>(
        "simulation", "a simulated room with people, rendered while it runs"));
