#include "evaluation/best.hpp"

#include <algorithm>
#include <string>

#include "evaluation/format.hpp"

namespace stillpoint::evaluation {

std::vector<bool> best_of(std::span<const std::optional<RatedFigure>> figures, Better better,
                          int digits) {
  std::vector<bool> best(figures.size(), false);
  double most = 0.0;
  for (const auto& figure : figures)
    if (figure) most = std::max(most, figure->coverage_percent);
  const auto can_be_compared = [&](const std::optional<RatedFigure>& figure) {
    return figure && figure->can_win && most - figure->coverage_percent <= kSameCoveragePercent;
  };
  std::vector<double> values;
  for (const auto& figure : figures)
    if (can_be_compared(figure)) values.push_back(figure->value);
  if (values.size() < 2 || better == Better::kNeither) return best;
  const auto [smallest, largest] = std::ranges::minmax(values);
  if (fixed(smallest, digits) == fixed(largest, digits)) return best;
  const std::string text = fixed(better == Better::kSmaller ? smallest : largest, digits);
  for (std::size_t i = 0; i < figures.size(); ++i)
    best[i] = can_be_compared(figures[i]) && fixed(figures[i]->value, digits) == text;
  return best;
}

}  // namespace stillpoint::evaluation
