// What the library provides: the type `my_plugin` of the kind `moving_checker`.
#include "my_plugin.hpp"

STILLPOINT_PLUGIN(my_plugin, "0.1.0",
                  stillpoint::provide<stillpoint::MovingChecker, plugins::my_plugin::MyPlugin>(
                      "my_plugin", "optical flow with depth against the camera's own motion"));
