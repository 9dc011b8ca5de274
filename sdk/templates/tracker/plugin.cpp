// What the library provides: the type `my_plugin` of the kind `tracker`.
#include "my_plugin.hpp"

STILLPOINT_PLUGIN(my_plugin, "0.1.0",
                  stillpoint::provide<stillpoint::Tracker, plugins::my_plugin::MyPlugin>(
                      "my_plugin", "odometry: ORB features against the last key frame"));
