#include "report/table_files.hpp"

#include <algorithm>

#include "study/csv_text.hpp"
#include "study/latex_table.hpp"

namespace stillpoint::report {
namespace {

constexpr const char* kLatexBegin = "% Needs \\usepackage{booktabs}.\n";
constexpr const char* kCsvBegin = "table,row,column,value,text,best,origin\n";

using study::csv_field;
using study::latex_text;
using study::Table;
using study::TableCell;

std::string latex_cell(const TableCell& cell) {
  std::string text = latex_text(cell.text);
  if (cell.best) text = "\\textbf{" + text + "}";
  return cell.significant ? text + "$^\\dagger$" : text;
}

study::LatexTable in_latex(const Table& table) {
  study::LatexTable result{
      .label = {},
      .caption = latex_text(table.title + "." + (table.note.empty() ? "" : " " + table.note)),
      .columns =
          std::string(table.names, 'l') + std::string(table.header.size() - table.names, 'r'),
      .header = {},
      .rows = {}};
  for (const std::string& title : table.header) result.header.push_back(latex_text(title));
  for (const std::vector<TableCell>& row : table.rows) {
    std::vector<std::string>& cells = result.rows.emplace_back();
    for (const TableCell& cell : row) cells.push_back(latex_cell(cell));
  }
  return result;
}

/// "walking/plain" where two columns name it.
std::string name_of(const std::vector<TableCell>& row, std::size_t names) {
  std::string text = row.front().text;
  for (std::size_t i = 1; i < names; ++i) text += "/" + row[i].text;
  return text;
}

}  // namespace

bool is_table_file(const std::string& text) {
  return text.starts_with(kLatexBegin) || text.starts_with(kCsvBegin);
}

std::string latex_tables(std::span<const Table> tables, Origins origins) {
  std::string text = kLatexBegin;
  for (std::string origin : origins) {
    std::ranges::replace(origin, '\n', ' ');
    text += "% " + origin + "\n";
  }
  for (const Table& table : tables) text += latex_table(in_latex(table));
  return text;
}

std::string csv_tables(std::span<const Table> tables, Origins origins) {
  std::string text = kCsvBegin;
  std::string origin;
  for (const std::string& line : origins) origin += (origin.empty() ? "" : " | ") + line;
  for (const Table& table : tables)
    for (const std::vector<TableCell>& row : table.rows)
      for (std::size_t i = table.names; i < row.size(); ++i)
        text += csv_field(table.title) + "," + csv_field(name_of(row, table.names)) + "," +
                csv_field(table.header[i]) + "," + study::csv_number(row[i].value) + "," +
                csv_field(row[i].text) + "," + (row[i].best ? "1" : "0") + "," + csv_field(origin) +
                "\n";
  return text;
}

}  // namespace stillpoint::report
