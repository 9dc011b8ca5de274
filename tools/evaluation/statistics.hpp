// The six figures by which errors are summed up.
#pragma once

#include <vector>

namespace stillpoint::evaluation {

/// In the unit of the errors. All zero without errors.
struct Statistics {
  double rmse = 0, mean = 0, median = 0;
  double standard_deviation = 0;  ///< of the population (divided by N), as numpy.std
  double min = 0, max = 0;
};

Statistics statistics_of(std::vector<double> errors);

}  // namespace stillpoint::evaluation
