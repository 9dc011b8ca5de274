#include "evaluation/comparison.hpp"

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>

#include "evaluation/best.hpp"
#include "evaluation/format.hpp"
#include "evaluation/report.hpp"

namespace stillpoint::evaluation {
namespace {

constexpr std::size_t kFieldWidth = 10;  // a star included
constexpr int kMetreDigits = 4;
constexpr double kMinShareOfPoses = 0.25;  // of the run with most, to be compared with it

using Figure = std::optional<double>;

struct Column {
  const char* title;
  const char* unit;
  int digits;
  bool is_error;
  std::function<Figure(const Contestant&)> value;
};

/// That have a true pose.
double poses_of(const Contestant& c) { return static_cast<double>(c.evaluation.pairs.size()); }

/// Nothing where positions do not determine it, see Evaluation::rigid_rotation_deg.
Figure rotation_of(const Contestant& c, AlignmentKind alignment) {
  const bool by_positions =
      alignment == AlignmentKind::kRigid || alignment == AlignmentKind::kSimilarity;
  if (by_positions && !c.evaluation.rigid_rotation_deg) return std::nullopt;
  return c.error.rotation_deg.rmse;
}

std::vector<Column> columns(AlignmentKind alignment) {
  return {
      {"coverage", "%", 1, false,
       [](const Contestant& c) { return Figure(100.0 * c.evaluation.span.share); }},
      {"poses", "", 0, false, [](const Contestant& c) { return Figure(poses_of(c)); }},
      {"ATE RMSE", "m", kMetreDigits, true,
       [](const Contestant& c) { return Figure(c.error.metres.rmse); }},
      {"median", "m", kMetreDigits, true,
       [](const Contestant& c) { return Figure(c.error.metres.median); }},
      {"max", "m", kMetreDigits, true,
       [](const Contestant& c) { return Figure(c.error.metres.max); }},
      {"rotation", "deg", 3, true, [=](const Contestant& c) { return rotation_of(c, alignment); }},
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
      {"scale", "", kMetreDigits, false, [](const Contestant& c) { return c.evaluation.scale; }}};
}

/// Of each contestant, whether its error is the smallest.
std::vector<bool> smallest(const Comparison& comparison, const Column& column) {
  double most = 0;
  for (const Contestant& one : comparison.contestants) most = std::max(most, poses_of(one));
  std::vector<std::optional<RatedFigure>> figures;
  for (const Contestant& one : comparison.contestants) {
    figures.emplace_back();
    if (const Figure value = column.value(one))
      figures.back() = {.value = *value,
                        .coverage_percent = 100.0 * one.evaluation.span.share,
                        .can_win = poses_of(one) >= kMinShareOfPoses * most};
  }
  return best_of(figures, column.is_error ? Better::kSmaller : Better::kNeither, column.digits);
}

std::string right(const std::string& text) {
  return text.size() < kFieldWidth ? std::string(kFieldWidth - text.size(), ' ') + text
                                   : " " + text;
}

std::string cell(const Contestant& contestant, const Column& column, bool best) {
  const Figure value = column.value(contestant);
  return right(value ? fixed(*value, column.digits) + (best ? "*" : " ") : "- ");
}

std::string left(const std::string& text, std::size_t width) {
  return text + std::string(width > width_of(text) ? width - width_of(text) : 0, ' ');
}

}  // namespace

std::string comparison_table(const Comparison& comparison) {
  std::size_t width = 4;
  for (const Contestant& one : comparison.contestants) width = std::max(width, width_of(one.name));
  const std::vector<Column> all = columns(comparison.alignment);
  std::string titles = left("run", width), units = left("", width);
  for (const Column& column : all) {
    titles += right(std::string(column.title) + " ");
    units += right(std::string(column.unit) + " ");
  }
  std::string text = titles + "\n" + units + "\n" + std::string(titles.size(), '-') + "\n";
  std::vector<std::vector<bool>> best;
  for (const Column& column : all) best.push_back(smallest(comparison, column));
  for (std::size_t k = 0; k < comparison.contestants.size(); ++k) {
    const Contestant& one = comparison.contestants[k];
    text += left(one.name, width);
    for (std::size_t i = 0; i < all.size(); ++i) text += cell(one, all[i], best[i][k]);
    text += "\n";
  }
  return text;
}

nlohmann::ordered_json comparison_json(const Comparison& comparison) {
  auto list = nlohmann::ordered_json::array();
  for (const Contestant& one : comparison.contestants) {
    nlohmann::ordered_json json = {{"name", one.name}};
    json.update(report_json(one.evaluation));
    const bool is_turned = rotation_of(one, comparison.alignment).has_value();
    const bool is_scaled = comparison.alignment == AlignmentKind::kSimilarity;
    using Json = nlohmann::ordered_json;
    json["aligned"] = {
        {"position_m", statistics_json(one.error.metres)},
        {"rotation_deg", is_turned ? statistics_json(one.error.rotation_deg) : Json()},
        {"scale", is_scaled && !one.evaluation.scale
                      ? Json()
                      : Json(one.error.reference_from_estimate.scale)}};
    list.push_back(std::move(json));
  }
  return list;
}

}  // namespace stillpoint::evaluation
