// Probabilities and their log-odds.
#pragma once

#include <cmath>

namespace stillpoint::decision_objects {

inline double log_odds(double probability) { return std::log(probability / (1 - probability)); }
inline double probability(double log_odds) { return 1 / (1 + std::exp(-log_odds)); }

}  // namespace stillpoint::decision_objects
