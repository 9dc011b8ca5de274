#include <stillpoint/sdk.hpp>

#include "output_web/web_output.hpp"

using stillpoint::Output;
using stillpoint::provide;

STILLPOINT_PLUGIN(output_web, "0.1.0",
                  provide<Output, stillpoint::output_web::WebOutput>(
                      "web", "a live view of the run in browsers"));
