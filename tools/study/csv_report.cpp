#include "study/csv_report.hpp"

#include "stillpoint/support/did_you_mean.hpp"
#include "study/csv_text.hpp"
#include "study/provenance.hpp"

namespace stillpoint::study {
namespace {

const char* state_of(const std::optional<CellResult>& result) {
  if (!result) return "missing";
  return result->failed() ? "failed" : "done";
}

std::string row(const Study& study, const Cell& cell, const std::optional<CellResult>& result,
                const std::string& command) {
  std::string text = study.sequences[cell.sequence].name + "," + study.variants[cell.variant].name +
                     "," + std::to_string(cell.repeat) + "," +
                     std::to_string(study.seed + cell.repeat) + "," + state_of(result) + ",";
  const CellResult known = result.value_or(CellResult{});
  if (result) text += std::to_string(known.exit_code);
  for (const std::optional<double>& value : known.values) text += "," + csv_number(value);
  text += ",";
  if (result) text += csv_number(known.seconds);
  const Origin& origin = known.origin;
  for (const std::string& field :
       {origin.version, origin.commit, origin.machine, origin.date, known.message, command})
    text += "," + csv_field(field);
  return text + "\n";
}

}  // namespace

std::string csv_report(const StudyResults& results) {
  std::string text = "sequence,variant,repeat,seed,state,exit_code";
  for (const Metric& metric : metrics()) text += std::string(",") + metric.key;
  text += ",seconds,version,commit,machine,date,message,command\n";
  for (std::size_t i = 0; i < results.cells.size(); ++i)
    text += row(results.study, results.cells[i], results.results[i], results.command);
  return text;
}

std::string csv_summary(const StudyResults& results) {
  const Study& study = results.study;
  std::string text =
      "sequence,variant,metric,runs,failed,missing,median,first_quartile,third_quartile,smallest,"
      "largest,study_origin\n";
  std::vector<std::string> lines = provenance(results);
  if (!results.command.empty()) lines.insert(lines.begin(), results.command);
  const std::string origin = csv_field(join(lines, " | "));
  for (std::size_t sequence = 0; sequence < study.sequences.size(); ++sequence)
    for (std::size_t variant = 0; variant < study.variants.size(); ++variant) {
      const auto [failed, missing] = results.without_result(sequence, variant);
      for (std::size_t metric = 0; metric < kMetricCount; ++metric) {
        const auto spread = results.spread(sequence, variant, static_cast<MetricId>(metric));
        const bool without_any = metric == kAte && failed + missing > 0;  // says so
        if (!spread && !without_any) continue;
        text += study.sequences[sequence].name + "," + study.variants[variant].name + "," +
                metrics()[metric].key + "," + std::to_string(spread ? spread->count : 0) + "," +
                std::to_string(failed) + "," + std::to_string(missing);
        for (const auto figure : {&Spread::median, &Spread::first_quartile, &Spread::third_quartile,
                                  &Spread::min, &Spread::max})
          text += "," + (spread ? csv_number(*spread.*figure) : "");
        text += "," + origin + "\n";
      }
    }
  return text;
}

}  // namespace stillpoint::study
