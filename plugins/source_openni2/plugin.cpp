#include "source_openni2/openni2_source.hpp"

STILLPOINT_PLUGIN(
    source_openni2, "0.1.0",
    stillpoint::provide<stillpoint::Source, stillpoint::source_openni2::OpenNi2Source>(
        "openni2", "a camera that OpenNI 2 has a driver for, live: Xtion, Astra, Carmine"));
