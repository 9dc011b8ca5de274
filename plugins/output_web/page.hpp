// The page that a browser gets, as one HTML file within the library.
#pragma once

#include <string_view>

namespace stillpoint::output_web {

std::string_view page();

}  // namespace stillpoint::output_web
