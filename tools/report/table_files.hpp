// The tables of a report for other programs.
#pragma once

#include <span>
#include <string>

#include "study/table.hpp"

namespace stillpoint::report {

/// The command, which builds made the runs, where and when, what is incomplete: a line each.
using Origins = std::span<const std::string>;

/// Tables with \toprule, \midrule and \bottomrule of the package booktabs, to be included by
/// \input. The best is bold; † stands behind what is significant. Origins are comments at the top.
std::string latex_tables(std::span<const study::Table> tables, Origins origins);

/// Columns: table, row, column, value, text, best, origin. A line per cell, quoted as in RFC 4180.
std::string csv_tables(std::span<const study::Table> tables, Origins origins);

/// Whether the text is what one of these two has given.
bool is_table_file(const std::string& text);

}  // namespace stillpoint::report
