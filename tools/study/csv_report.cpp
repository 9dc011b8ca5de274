#include "study/csv_report.hpp"

#include <array>
#include <charconv>

namespace stillpoint::study {
namespace {

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += '"';
    result += c;
  }
  return result + '"';
}

// Nine digits: more than any of the figures means, and no rounding noise.
std::string number(const std::optional<double>& value) {
  if (!value) return {};
  std::array<char, 32> text{};
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), *value, std::chars_format::general, 9);
  return {text.data(), end.ptr};
}

const char* state_of(const std::optional<CellResult>& result) {
  if (!result) return "missing";
  return result->failed() ? "failed" : "done";
}

std::string row(const Study& study, const Cell& cell, const std::optional<CellResult>& result) {
  std::string text = study.sequences[cell.sequence].name + "," + study.variants[cell.variant].name +
                     "," + std::to_string(cell.repeat) + "," +
                     std::to_string(study.seed + cell.repeat) + "," + state_of(result) + ",";
  const CellResult known = result.value_or(CellResult{});
  if (result) text += std::to_string(known.exit_code);
  for (const std::optional<double>& value : known.values) text += "," + number(value);
  text += ",";
  if (result) text += number(known.seconds);
  const Origin& origin = known.origin;
  for (const std::string& field :
       {origin.version, origin.commit, origin.machine, origin.date, known.message})
    text += "," + quoted(field);
  return text + "\n";
}

}  // namespace

std::string csv_report(const StudyResults& results) {
  std::string text = "sequence,variant,repeat,seed,state,exit_code";
  for (const Metric& metric : metrics()) text += std::string(",") + metric.key;
  text += ",seconds,version,commit,machine,date,message\n";
  for (std::size_t i = 0; i < results.cells.size(); ++i)
    text += row(results.study, results.cells[i], results.results[i]);
  return text;
}

}  // namespace stillpoint::study
