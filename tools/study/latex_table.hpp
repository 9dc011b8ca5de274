// Tables of LaTeX with the package booktabs.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace stillpoint::study {

/// UTF-8 text without anything that LaTeX takes for a command.
std::string latex_text(std::string_view text);

/// Its texts are LaTeX already.
struct LatexTable {
  std::string label;  ///< may be empty
  std::string caption;
  std::string columns;  ///< "lrr"
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;  ///< an empty one is a gap between groups
};

std::string latex_table(const LatexTable& table);

}  // namespace stillpoint::study
