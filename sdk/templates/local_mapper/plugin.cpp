// What the library provides: the type `my_plugin` of the kind `local_mapper`.
#include "my_plugin.hpp"

STILLPOINT_PLUGIN(my_plugin, "0.1.0",
                  stillpoint::provide<stillpoint::LocalMapper, plugins::my_plugin::MyPlugin>(
                      "my_plugin", "landmarks from depth, culled when they are not found again"));
