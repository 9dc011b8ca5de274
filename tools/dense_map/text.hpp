// Text as printf makes it.
#pragma once

#include <cstddef>
#include <cstdio>
#include <string>

namespace stillpoint::dense_map {

template <class... Values>
std::string text(const char* format, Values... values) {
  std::string result(static_cast<std::size_t>(std::snprintf(nullptr, 0, format, values...)), '\0');
  std::snprintf(result.data(), result.size() + 1, format, values...);
  return result;
}

}  // namespace stillpoint::dense_map
