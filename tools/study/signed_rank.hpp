// Wilcoxon's signed-rank test, and Holm's correction for several tests.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace stillpoint::study {

struct SignedRank {
  std::size_t pairs = 0;  ///< without those whose difference is 0
  double effect = 0.0;    ///< matched-pairs rank-biserial correlation; 1: all are positive
  double p = 1.0;         ///< two-sided
};

/// Of paired differences, infinite ones included: could their signs be chance? (Wilcoxon,
/// Individual comparisons by ranking methods, 1945; effect: Kerby, The simple difference formula,
/// 2014.) Equal differences share their mean rank. Exact up to 50 pairs, the normal approximation
/// beyond.
SignedRank signed_rank(std::span<const double> differences);

/// The p of so many pairs if all differences have one sign: none is smaller.
double smallest_p(std::size_t pairs);

/// p values of several tests, corrected for their number, in the same order (Holm, A simple
/// sequentially rejective multiple test procedure, 1979).
std::vector<double> corrected_for_number(std::span<const double> p_values);

}  // namespace stillpoint::study
