#include "evaluation/format.hpp"

#include <algorithm>
#include <iomanip>
#include <sstream>

namespace stillpoint::evaluation {

std::string fixed(double value, int digits, int width) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(digits) << std::setw(width) << value;
  return text.str();
}

std::size_t width_of(const std::string& text) {
  // Continuation bytes begin with the bits 10.
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
}

}  // namespace stillpoint::evaluation
