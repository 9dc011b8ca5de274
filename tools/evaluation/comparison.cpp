#include "evaluation/comparison.hpp"

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>

#include "evaluation/format.hpp"
#include "evaluation/report.hpp"

namespace stillpoint::evaluation {
namespace {

constexpr double kSameCoverage = 0.01;
constexpr std::size_t kFieldWidth = 10;  // a star included
constexpr int kMetreDigits = 4;

using Figure = std::optional<double>;

struct Column {
  const char* title;
  const char* unit;
  int digits;
  bool is_error;
  std::function<Figure(const Contestant&)> value;
};

std::vector<Column> columns() {
  return {{"coverage", "%", 1, false,
           [](const Contestant& c) { return Figure(100.0 * c.evaluation.span.share); }},
          {"ATE RMSE", "m", kMetreDigits, true,
           [](const Contestant& c) { return Figure(c.error.metres.rmse); }},
          {"median", "m", kMetreDigits, true,
           [](const Contestant& c) { return Figure(c.error.metres.median); }},
          {"max", "m", kMetreDigits, true,
           [](const Contestant& c) { return Figure(c.error.metres.max); }},
          {"rotation", "deg", 3, true,
           [](const Contestant& c) { return Figure(c.error.rotation_deg.rmse); }},
          {"RPE", "m", kMetreDigits, true,
           [](const Contestant& c) {
             const auto& relative = c.evaluation.relative;
             return relative ? Figure(relative->translation_m.rmse) : Figure();
           }},
          {"rotation", "deg", 3, true,
           [](const Contestant& c) {
             const auto& relative = c.evaluation.relative;
             return relative ? Figure(relative->rotation_deg.rmse) : Figure();
           }},
          {"scale", "", kMetreDigits, false, [](const Contestant& c) {
             return Figure(c.evaluation.similarity.reference_from_estimate.scale);
           }}};
}

/// Of those that cover enough; nothing when it is the only one.
Figure smallest(const Comparison& comparison, const Column& column) {
  double most = 0.0;
  for (const Contestant& one : comparison.contestants)
    most = std::max(most, one.evaluation.span.share);
  Figure best;
  for (const Contestant& one : comparison.contestants)
    if (const Figure value = column.value(one);
        value && one.evaluation.span.share >= most - kSameCoverage)
      best = std::min(best.value_or(*value), *value);
  return comparison.contestants.size() > 1 ? best : Figure();
}

std::string right(const std::string& text) {
  return text.size() < kFieldWidth ? std::string(kFieldWidth - text.size(), ' ') + text
                                   : " " + text;
}

std::string cell(const Contestant& contestant, const Column& column, const Figure& best) {
  const Figure value = column.value(contestant);
  if (!value) return right("- ");
  return right(fixed(*value, column.digits) + (column.is_error && best == value ? "*" : " "));
}

std::string left(const std::string& text, std::size_t width) {
  return text + std::string(width > width_of(text) ? width - width_of(text) : 0, ' ');
}

}  // namespace

std::string comparison_table(const Comparison& comparison) {
  std::size_t width = 4;
  for (const Contestant& one : comparison.contestants) width = std::max(width, width_of(one.name));
  const std::vector<Column> all = columns();
  std::string titles = left("run", width), units = left("", width);
  for (const Column& column : all) {
    titles += right(std::string(column.title) + " ");
    units += right(std::string(column.unit) + " ");
  }
  std::string text = titles + "\n" + units + "\n" + std::string(titles.size(), '-') + "\n";
  std::vector<Figure> best;
  for (const Column& column : all) best.push_back(smallest(comparison, column));
  for (const Contestant& one : comparison.contestants) {
    text += left(one.name, width);
    for (std::size_t i = 0; i < all.size(); ++i) text += cell(one, all[i], best[i]);
    text += "\n";
  }
  return text;
}

nlohmann::ordered_json comparison_json(const Comparison& comparison) {
  auto list = nlohmann::ordered_json::array();
  for (const Contestant& one : comparison.contestants) {
    nlohmann::ordered_json json = {{"name", one.name}};
    json.update(report_json(one.evaluation));
    json["aligned"] = {{"position_m", statistics_json(one.error.metres)},
                       {"rotation_deg", statistics_json(one.error.rotation_deg)},
                       {"scale", one.error.reference_from_estimate.scale}};
    list.push_back(std::move(json));
  }
  return list;
}

}  // namespace stillpoint::evaluation
