#include <sstream>

#include "inspection/audit_report.hpp"
#include "inspection/number_text.hpp"
#include "inspection/pair_report.hpp"
#include "inspection/report_text.hpp"

namespace stillpoint::inspection {
namespace {

std::string truth_text(const std::optional<TruthAudit>& truth) {
  if (!truth) return "none";
  return std::to_string(truth->poses) + " poses, " + percent(truth->covered) +
         " of the frames within 20 ms" +
         (truth->unusable_lines > 0
              ? ", " + std::to_string(truth->unusable_lines) + " unusable lines"
              : "");
}

}  // namespace

std::string report_table(const RecordingAudit& audit) {
  std::ostringstream out;
  out << audit.recording.folder.string() << '\n';
  if (audit.camera) row(out, "camera", audit.camera->name);
  print_streams(out, audit, "", "",
                audit.recording.pairs_from.empty()
                    ? "by time stamp"
                    : "from " + audit.recording.pairs_from.filename().string());
  print_images(out, audit);
  row(out, "ground truth", truth_text(audit.truth));
  print_depth(out, audit);
  print_warnings(out, audit);
  return out.str();
}

}  // namespace stillpoint::inspection
