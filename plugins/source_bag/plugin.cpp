#include "source_bag/bag_source.hpp"

STILLPOINT_PLUGIN(source_bag, "0.1.0",
                  stillpoint::provide<stillpoint::Source, stillpoint::source_bag::BagSource>(
                      "bag", "bags of ROS 1 (.bag) and ROS 2 (.mcap, .db3), without ROS"));
