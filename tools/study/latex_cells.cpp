#include "study/latex_cells.hpp"

#include <algorithm>
#include <string_view>
#include <vector>

#include "evaluation/format.hpp"
#include "stillpoint/support/did_you_mean.hpp"
#include "study/table_cells.hpp"

namespace stillpoint::study {
namespace {

using evaluation::fixed;

constexpr const char* kBold = "\\textbf{";
constexpr const char* kItalic = "\\textit{";
constexpr const char* kBracket = "{\\scriptsize [";

std::string number(double value, int digits) {
  const std::string text = fixed(value, digits);
  return text.starts_with('-') ? "$-$" + text.substr(1) : text;
}

bool has(const LatexTable& table, std::string_view mark) {
  return std::ranges::any_of(table.rows, [&](const std::vector<std::string>& row) {
    return std::ranges::any_of(
        row, [&](const std::string& cell) { return cell.find(mark) != std::string::npos; });
  });
}

/// Of all cells.
std::string text_in_brackets(const LatexTable& table) {
  std::string text;
  for (const std::vector<std::string>& row : table.rows)
    for (const std::string& cell : row)
      for (std::size_t at = cell.find(kBracket); at != std::string::npos;
           at = cell.find(kBracket, at + 1))
        text += cell.substr(at, cell.find(']', at) - at) + "\n";
  return text;
}

}  // namespace

std::string latex_bold(const std::string& text) { return kBold + text + "}"; }
std::string latex_italic(const std::string& text) { return kItalic + text + "}"; }

std::string latex_spread(const std::optional<Spread>& spread, int digits, bool best) {
  if (!spread) return kNoFigure;
  const std::string median = number(spread->median, digits);
  std::string text = best ? latex_bold(median) : median;
  if (spread->count > 1)
    text += " {\\scriptsize (" + number(spread->min, digits) + (spread->min < 0 ? " to " : "--") +
            number(spread->max, digits) + ")}";
  return text;
}

std::string latex_ratio(const std::optional<Spread>& spread) {
  if (!spread) return kNoFigure;
  const int digits = ratio_digits(*spread);
  std::string text = fixed(spread->median, digits);
  if (spread->count > 1)
    text += " {\\scriptsize (" + fixed(spread->first_quartile, digits) + "--" +
            fixed(spread->third_quartile, digits) + ")}";
  return text;
}

std::string latex_published(const Published& system, const std::string& recording,
                            MetricId metric) {
  const auto value = system.find(recording, metric);
  return value ? latex_italic(fixed(*value, metrics()[metric].digits)) : kNoFigure;
}

std::string latex_limit(const std::string& note) {
  return note.empty() ? "" : std::string(" ") + kBracket + note + "]}";
}

std::string brackets_note(const LatexTable& table) {
  const std::string text = text_in_brackets(table);
  std::vector<std::string> meanings;
  const auto add = [&](const char* mark, const char* meaning) {
    if (text.find(mark) != std::string::npos) meanings.emplace_back(meaning);
  };
  add("%", "coverage, where it is below 100\\,\\%");
  add(" of ", "how many runs a figure is of, where not all have one");
  add("failed", "failed: no run has come to its end");
  return meanings.empty() ? "" : " In brackets: " + join(meanings, "; ") + ".";
}

std::string bold_note(const LatexTable& table, const std::string& note) {
  return has(table, kBold) ? note : "";
}

bool has_italics(const LatexTable& table) { return has(table, kItalic); }

}  // namespace stillpoint::study
