// The tables of a report for other programs.
#pragma once

#include <span>
#include <string>

#include "study/table.hpp"

namespace stillpoint::report {

/// Tables with \toprule, \midrule and \bottomrule of the package booktabs, to be included by
/// \input. The best is bold; † stands behind what is significant.
std::string latex_tables(std::span<const study::Table> tables);

/// Columns: table, row, column, value, text, best. A line per cell, quoted as in RFC 4180.
std::string csv_tables(std::span<const study::Table> tables);

}  // namespace stillpoint::report
