#include "report/table_files.hpp"

#include <array>
#include <cstdio>
#include <string_view>
#include <utility>

namespace stillpoint::report {
namespace {

constexpr std::pair<std::string_view, std::string_view> kLatex[] = {{"\\", "\\textbackslash{}"},
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
                                                                    {"†", "$^\\dagger$"},
                                                                    {"–", "--"},
                                                                    {"×", "$\\times$"},
                                                                    {"÷", "$\\div$"}};

std::string latex_text(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    std::string_view from = text.substr(0, 1), to = from;
    for (const auto& [symbol, command] : kLatex)
      if (text.starts_with(symbol)) from = symbol, to = command;
    result += to;
    text.remove_prefix(from.size());
  }
  return result;
}

std::string latex_cell(const TableCell& cell) {
  std::string text = latex_text(cell.text);
  if (cell.best) text = "\\textbf{" + text + "}";
  return cell.significant ? text + "$^\\dagger$" : text;
}

std::string latex_table(const Table& table) {
  std::string text = "\\begin{table}\n  \\centering\n  \\caption{" + latex_text(table.title) + ".";
  if (!table.note.empty()) text += " " + latex_text(table.note);
  text += "}\n  \\begin{tabular}{l" + std::string(table.header.size() - 1, 'r') +
          "}\n    \\toprule\n    ";
  for (std::size_t i = 0; i < table.header.size(); ++i)
    text += (i > 0 ? " & " : "") + latex_text(table.header[i]);
  text += " \\\\\n    \\midrule\n";
  for (const std::vector<TableCell>& row : table.rows) {
    text += "    ";
    for (std::size_t i = 0; i < row.size(); ++i) text += (i > 0 ? " & " : "") + latex_cell(row[i]);
    text += " \\\\\n";
  }
  return text + "    \\bottomrule\n  \\end{tabular}\n\\end{table}\n";
}

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string number_text(const std::optional<double>& value) {
  if (!value) return {};
  std::array<char, 32> digits{};
  std::snprintf(digits.data(), digits.size(), "%.9g", *value);
  return digits.data();
}

}  // namespace

std::string latex_tables(std::span<const Table> tables) {
  std::string text = "% Needs \\usepackage{booktabs}.\n";
  for (const Table& table : tables) text += "\n" + latex_table(table);
  return text;
}

std::string csv_tables(std::span<const Table> tables) {
  std::string text = "table,row,column,value,text,best\n";
  for (const Table& table : tables)
    for (const std::vector<TableCell>& row : table.rows)
      for (std::size_t i = 1; i < row.size(); ++i)
        text += csv_field(table.title) + "," + csv_field(row[0].text) + "," +
                csv_field(table.header[i]) + "," + number_text(row[i].value) + "," +
                csv_field(row[i].text) + "," + (row[i].best ? "1" : "0") + "\n";
  return text;
}

}  // namespace stillpoint::report
