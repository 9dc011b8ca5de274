#include "study/latex_table.hpp"

#include <utility>

namespace stillpoint::study {
namespace {

// After the end of a row, [ and * would belong to its `\\`.
constexpr std::pair<std::string_view, std::string_view> kSpecial[] = {{"\\", "\\textbackslash{}"},
                                                                      {"_", "\\_"},
                                                                      {"&", "\\&"},
                                                                      {"%", "\\%"},
                                                                      {"#", "\\#"},
                                                                      {"$", "\\$"},
                                                                      {"{", "\\{"},
                                                                      {"}", "\\}"},
                                                                      {"~", "\\textasciitilde{}"},
                                                                      {"^", "\\^{}"},
                                                                      {"<", "$<$"},
                                                                      {">", "$>$"},
                                                                      {"[", "{[}"},
                                                                      {"*", "{*}"},
                                                                      {"†", "$^\\dagger$"},
                                                                      {"–", "--"},
                                                                      {"−", "$-$"},
                                                                      {"×", "$\\times$"},
                                                                      {"÷", "$\\div$"}};

std::string line_of(const std::vector<std::string>& cells) {
  std::string text = "    ";
  for (const std::string& cell : cells) text += (&cell == &cells.front() ? "" : " & ") + cell;
  return text + " \\\\\n";
}

}  // namespace

std::string latex_text(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    std::string_view from = text.substr(0, 1), to = from;
    for (const auto& [symbol, command] : kSpecial)
      if (text.starts_with(symbol)) {
        from = symbol;
        to = command;
      }
    result += to;
    text.remove_prefix(from.size());
  }
  return result;
}

std::string latex_table(const LatexTable& table) {
  std::string text = "\n\\begin{table*}\n  \\centering\n  \\caption{" + table.caption + "}\n";
  if (!table.label.empty()) text += "  \\label{tab:" + table.label + "}\n";
  text += "  \\small\\setlength{\\tabcolsep}{4pt}\n  \\begin{tabular}{" + table.columns +
          "}\n    \\toprule\n" + line_of(table.header) + "    \\midrule\n";
  for (const std::vector<std::string>& row : table.rows)
    text += row.empty() ? "    \\addlinespace\n" : line_of(row);
  return text + "    \\bottomrule\n  \\end{tabular}\n\\end{table*}\n";
}

}  // namespace stillpoint::study
