// Each variant beside the baseline of its study.
#pragma once

#include <vector>

#include "study/paired_comparison.hpp"
#include "study/table.hpp"

namespace stillpoint::study {

/// Empty when nothing is compared.
Table comparison_table(const Study& study, const std::vector<PairedComparison>& comparisons);

}  // namespace stillpoint::study
