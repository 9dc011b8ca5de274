#include "inspection/audit_report.hpp"
#include "inspection/pair_report.hpp"

namespace stillpoint::inspection {
namespace {

using Json = nlohmann::ordered_json;

Json truth_json(const std::optional<TruthAudit>& truth) {
  if (!truth) return nullptr;
  return {{"poses", truth->poses},
          {"unusable_lines", truth->unusable_lines},
          {"covered", truth->covered},
          {"begin", truth->begin},
          {"end", truth->end}};
}

}  // namespace

Json report_json(const RecordingAudit& audit) {
  const std::string from = audit.recording.pairs_from.filename().string();
  Json json = {{"folder", audit.recording.folder.string()},
               {"camera", audit.camera ? Json(audit.camera->name) : Json(nullptr)}};
  json.update(pair_json(audit));
  json["paired_by"] = from.empty() ? "time" : from;
  json["ground_truth"] = truth_json(audit.truth);
  json["warnings"] = audit.warnings;
  return json;
}

}  // namespace stillpoint::inspection
