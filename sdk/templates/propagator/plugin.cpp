// What the library provides: the type `my_plugin` of the kind `propagator`.
#include "my_plugin.hpp"

STILLPOINT_PLUGIN(my_plugin, "0.1.0",
                  stillpoint::provide<stillpoint::Propagator, plugins::my_plugin::MyPlugin>(
                      "my_plugin", "moves each object by the median optical flow of its points"));
