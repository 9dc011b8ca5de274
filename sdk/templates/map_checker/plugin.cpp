// What the library provides: the type `my_plugin` of the kind `map_checker`.
#include "my_plugin.hpp"

STILLPOINT_PLUGIN(my_plugin, "0.1.0",
                  stillpoint::provide<stillpoint::MapChecker, plugins::my_plugin::MyPlugin>(
                      "my_plugin", "depth compared with an earlier frame"));
