#include "study/provenance.hpp"

#include <algorithm>
#include <optional>

namespace stillpoint::study {
namespace {

/// Runs that one build made on one machine.
struct Batch {
  std::string made_by;
  std::string first_date, last_date;
  std::size_t runs = 0;
};

std::vector<Batch> batches_of(const StudyResults& results) {
  std::vector<Batch> batches;
  for (const std::optional<CellResult>& result : results.results) {
    if (!result) continue;
    const std::string made_by = build_text(result->origin), &date = result->origin.date;
    auto batch = std::ranges::find(batches, made_by, &Batch::made_by);
    if (batch == batches.end()) batch = batches.insert(batches.end(), {made_by, date, date});
    batch->first_date = std::min(batch->first_date, date);
    batch->last_date = std::max(batch->last_date, date);
    ++batch->runs;
  }
  return batches;
}

}  // namespace

std::vector<std::string> provenance(const StudyResults& results) {
  std::vector<std::string> lines;
  const std::vector<Batch> batches = batches_of(results);
  const std::string total = std::to_string(results.results.size() - results.missing());
  for (const Batch& batch : batches) {
    std::string line;
    if (batches.size() > 1) line = std::to_string(batch.runs) + " of " + total + " runs: ";
    line += batch.made_by;
    if (!batch.first_date.empty()) line += "; " + batch.first_date;
    if (batch.last_date != batch.first_date) line += " to " + batch.last_date;
    lines.push_back(std::move(line));
  }
  return lines;
}

}  // namespace stillpoint::study
