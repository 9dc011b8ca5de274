// What the library provides: the type `my_plugin` of the kind `output`.
#include "my_plugin.hpp"

STILLPOINT_PLUGIN(my_plugin, "0.1.0",
                  stillpoint::provide<stillpoint::Output, plugins::my_plugin::MyPlugin>(
                      "my_plugin", "one line of CSV per frame"));
