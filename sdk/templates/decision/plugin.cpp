// What the library provides: the type `my_plugin` of the kind `decision`.
#include "my_plugin.hpp"

STILLPOINT_PLUGIN(my_plugin, "0.1.0",
                  stillpoint::provide<stillpoint::Decision, plugins::my_plugin::MyPlugin>(
                      "my_plugin", "weight 0 for objects with moving points"));
