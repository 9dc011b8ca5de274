// Numbers as people read them.
#pragma once

#include <cstdio>
#include <string>

namespace stillpoint::inspection {

/// `value` with `digits` after the point.
inline std::string fixed(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

inline std::string percent(double share) { return fixed(100 * share, 1) + " %"; }

}  // namespace stillpoint::inspection
