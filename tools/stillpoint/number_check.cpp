#include <cmath>

#include "commands.hpp"
#include "stillpoint/error.hpp"

namespace stillpoint {

void require_numbers(std::initializer_list<double> values) {
  for (const double value : values)
    if (std::isnan(value)) throw Error(Fault::kUsage, "'nan' is not a value of an option");
}

}  // namespace stillpoint
