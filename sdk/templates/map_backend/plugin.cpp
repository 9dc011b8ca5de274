// What the library provides: the type `my_plugin` of the kind `map_backend`.
#include "my_plugin.hpp"

STILLPOINT_PLUGIN(my_plugin, "0.1.0",
                  stillpoint::provide<stillpoint::MapBackend, plugins::my_plugin::MyPlugin>(
                      "my_plugin", "a point cloud, one point per voxel"));
