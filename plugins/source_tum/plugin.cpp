#include "source_tum/tum_source.hpp"

STILLPOINT_PLUGIN(source_tum, "0.1.0",
                  stillpoint::provide<stillpoint::Source, stillpoint::source_tum::TumSource>(
                      "tum_rgbd", "recordings in the format of the TUM RGB-D benchmark"));
