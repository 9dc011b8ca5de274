// Which of several figures is the best.
#pragma once

#include <algorithm>
#include <span>

#include "evaluation/format.hpp"
#include "report/report_data.hpp"

namespace stillpoint::report {

/// Figures whose coverage differs by less than this, in per cent of the frames, cover the same.
inline constexpr double kSameCoverage = 1.0;

/// Marks the best of the cells, which all have a value, and those that read the same with so many
/// digits; none when all read the same.
inline void mark_best(std::span<TableCell* const> cells, bool larger_is_better, int digits) {
  if (cells.empty()) return;
  const auto value = [](const TableCell* cell) { return *cell->value; };
  const auto [smallest, largest] = std::ranges::minmax(cells, {}, value);
  const std::string best =
      evaluation::fixed(*(larger_is_better ? largest : smallest)->value, digits);
  const auto is_best = [&](const TableCell* cell) {
    return evaluation::fixed(*cell->value, digits) == best;
  };
  if (std::ranges::all_of(cells, is_best)) return;
  for (TableCell* cell : cells) cell->best = is_best(cell);
}

}  // namespace stillpoint::report
