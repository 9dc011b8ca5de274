#include "evaluation/statistics.hpp"

#include <algorithm>
#include <cmath>

namespace stillpoint::evaluation {

Statistics statistics_of(std::vector<double> errors) {
  Statistics result;
  if (errors.empty()) return result;
  std::sort(errors.begin(), errors.end());
  const double count = static_cast<double>(errors.size());
  double sum = 0, squares = 0, deviations = 0;
  for (double error : errors) {
    sum += error;
    squares += error * error;
  }
  result.mean = sum / count;
  result.rmse = std::sqrt(squares / count);
  for (double error : errors) deviations += (error - result.mean) * (error - result.mean);
  result.standard_deviation = std::sqrt(deviations / count);
  const std::size_t middle = errors.size() / 2;
  result.median =
      errors.size() % 2 == 1 ? errors[middle] : 0.5 * (errors[middle - 1] + errors[middle]);
  result.min = errors.front();
  result.max = errors.back();
  return result;
}

}  // namespace stillpoint::evaluation
