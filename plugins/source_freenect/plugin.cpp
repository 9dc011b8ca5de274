#include "source_freenect/freenect_source.hpp"

STILLPOINT_PLUGIN(
    source_freenect, "0.1.0",
    stillpoint::provide<stillpoint::Source, stillpoint::source_freenect::FreenectSource>(
        "freenect", "a Kinect v1 (Xbox 360), live, through libfreenect"));
