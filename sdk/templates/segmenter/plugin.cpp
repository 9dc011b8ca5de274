// What the library provides: the type `my_plugin` of the kind `segmenter`.
#include "my_plugin.hpp"

STILLPOINT_PLUGIN(my_plugin, "0.1.0",
                  stillpoint::provide<stillpoint::Segmenter, plugins::my_plugin::MyPlugin>(
                      "my_plugin", "labels what has a colour"));
