// An evaluation in words and figures.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "evaluation/evaluation.hpp"

namespace stillpoint::evaluation {

/// A table for people, ending with a line break.
std::string report_table(const Evaluation& evaluation);

/// The same figures for programs; units are part of the names.
nlohmann::ordered_json report_json(const Evaluation& evaluation);

/// {"rmse": …, "mean": …, "median": …, "sd": …, "min": …, "max": …}
nlohmann::ordered_json statistics_json(const Statistics& statistics);

}  // namespace stillpoint::evaluation
