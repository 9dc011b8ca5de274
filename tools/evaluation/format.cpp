#include "evaluation/format.hpp"

#include <iomanip>
#include <sstream>

namespace stillpoint::evaluation {

std::string fixed(double value, int digits, int width) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(digits) << std::setw(width) << value;
  return text.str();
}

}  // namespace stillpoint::evaluation
