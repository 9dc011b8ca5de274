// What the library provides: the type `my_plugin` of the kind `loop_closer`.
#include "my_plugin.hpp"

STILLPOINT_PLUGIN(my_plugin, "0.1.0",
                  stillpoint::provide<stillpoint::LoopCloser, plugins::my_plugin::MyPlugin>(
                      "my_plugin", "matches nearby key frames and distributes the drift linearly"));
