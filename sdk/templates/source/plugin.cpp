// What the library provides: the type `my_plugin` of the kind `source`.
#include "my_plugin.hpp"

STILLPOINT_PLUGIN(my_plugin, "0.1.0",
                  stillpoint::provide<stillpoint::Source, plugins::my_plugin::MyPlugin>(
                      "my_plugin", "a textured wall that the camera moves along"));
