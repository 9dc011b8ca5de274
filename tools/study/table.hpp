// A table of figures, before it becomes Markdown, LaTeX, CSV or a part of a page.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace stillpoint::study {

/// With what LaTeX and HTML set off.
struct TableCell {
  std::string text;
  std::optional<double> value;  ///< by which tables sort
  bool best = false;            ///< of its row or recording, see evaluation/best.hpp
  bool significant = false;     ///< better or worse than the baseline, corrected p < 0.05
};

struct Table {
  std::string title;  ///< with the unit
  std::string note;   ///< sentences below it
  std::vector<std::string> header;
  std::vector<std::vector<TableCell>> rows;  ///< each as long as the header
  std::size_t names = 1;                     ///< columns at the left that name a row
};

}  // namespace stillpoint::study
