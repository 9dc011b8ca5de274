#include "study/markdown_table.hpp"

#include <algorithm>

#include "evaluation/format.hpp"

namespace stillpoint::study {
namespace {

using evaluation::width_of;

// A bar would end the column.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '|') result += '\\';
    result += c;
  }
  return result;
}

}  // namespace

std::string markdown_table(const std::vector<std::string>& header,
                           const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::vector<std::string>> lines = {header};
  lines.insert(lines.end(), rows.begin(), rows.end());
  std::vector<std::size_t> widths(header.size(), 3);  // of the rule below the header
  for (std::vector<std::string>& line : lines)
    for (std::size_t column = 0; column < line.size(); ++column) {
      line[column] = escaped(line[column]);
      widths[column] = std::max(widths[column], width_of(line[column]));
    }
  std::string text, rule;
  for (const std::size_t width : widths) rule += "|" + std::string(width + 2, '-');
  for (const std::vector<std::string>& line : lines) {
    for (std::size_t column = 0; column < line.size(); ++column)
      text += "| " + line[column] + std::string(widths[column] - width_of(line[column]) + 1, ' ');
    text += "|\n";
    if (&line == &lines.front()) text += rule + "|\n";
  }
  return text;
}

}  // namespace stillpoint::study
