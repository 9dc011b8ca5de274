#include <algorithm>
#include <sstream>

#include "inspection/audit_report.hpp"
#include "inspection/number_text.hpp"
#include "inspection/report_text.hpp"

namespace stillpoint::inspection {
namespace {

std::string counts_text(const std::map<std::string, int>& kinds) {
  std::string text;
  for (const auto& [kind, count] : kinds)
    text += std::string(text.empty() ? "" : "; ") + kind +
            (kinds.size() > 1 ? " (" + std::to_string(count) + ")" : "");
  return text.empty() ? "none could be read" : text;
}

std::string offset_text(const TimeOffset& offset) {
  if (!offset.known) return "cannot tell: " + offset.reason;
  return std::string(offset.offset >= 0 ? "+" : "") + milliseconds(offset.offset) + " ± " +
         milliseconds(offset.deviation) + " to be added to depth stamps (correlation " +
         fixed(offset.correlation, 2) + ")";
}

std::string truth_text(const std::optional<TruthAudit>& truth) {
  if (!truth) return "none";
  return std::to_string(truth->poses) + " poses, " + percent(truth->covered) +
         " of the frames within 20 ms" +
         (truth->unusable_lines > 0
              ? ", " + std::to_string(truth->unusable_lines) + " unusable lines"
              : "");
}

void print_streams(std::ostream& out, const RecordingAudit& audit) {
  const double start = audit.color.begin;
  row(out, "colour", stream_text(audit.color, start));
  row(out, "depth", stream_text(audit.depth, start));
  row(out, "pairs",
      stream_text(audit.pairs, start) + "; " +
          (audit.recording.pairs_from.empty()
               ? "by time stamp"
               : "from " + audit.recording.pairs_from.filename().string()));
  row(out, "unpaired",
      std::to_string(audit.color.images - audit.pairs.images) + " colour, " +
          std::to_string(audit.depth.images - audit.pairs.images) + " depth");
  row(out, "stamps of a pair",
      "differ by " + milliseconds(audit.mean_difference, 1) + " on average, " +
          milliseconds(audit.max_difference, 1) + " at most");
}

void print_depth(std::ostream& out, const RecordingAudit& audit) {
  constexpr double kEdges[] = {0, 0.5, 1, 1.5, 2, 3, 4, 6, 10, 1e6};  // metres
  constexpr int kBarLength = 40;
  const DepthStatistics& depth = audit.depth_values;
  row(out, "valid depth", percent(depth.valid_share()) + " of the pixels");
  const auto metres = [&](double share) {
    return fixed(depth.quantile(share) / audit.depth_factor, 2) + " m";
  };
  row(out, "depth range",
      "5 % nearer than " + metres(0.05) + ", half than " + metres(0.5) + ", 95 % than " +
          metres(0.95) + " (factor " + fixed(audit.depth_factor, 0) +
          (audit.camera ? ")" : " assumed; name the camera with --camera)"));
  double largest = 1e-9;
  std::vector<double> shares;
  for (std::size_t i = 0; i + 1 < std::size(kEdges); ++i) {
    shares.push_back(depth.share_between(kEdges[i], kEdges[i + 1], audit.depth_factor));
    largest = std::max(largest, shares.back());
  }
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const std::string to =
        i + 1 < shares.size() ? std::string("– ") + fixed(kEdges[i + 1], 1) + " m" : "m and up";
    const std::string label = fixed(kEdges[i], 1) + " " + to;
    std::string bar;
    for (int k = 0; k < static_cast<int>(kBarLength * shares[i] / largest + 0.5); ++k) bar += "█";
    const std::string share = percent(shares[i]);
    out << "    " << std::string(i + 1 < shares.size() ? 16 - label.size() : 14 - label.size(), ' ')
        << label << std::string(10 - share.size(), ' ') << share << "  " << bar << '\n';
  }
}

}  // namespace

std::string report_table(const RecordingAudit& audit) {
  std::ostringstream out;
  out << audit.recording.folder.string() << '\n';
  if (audit.camera) row(out, "camera", audit.camera->name);
  print_streams(out, audit);
  row(out, "colour images", counts_text(audit.color_kinds));
  row(out, "depth images",
      counts_text(audit.depth_kinds) + " (" + std::to_string(audit.sampled) + " pairs sampled)");
  row(out, "time offset", offset_text(audit.time_offset));
  row(out, "ground truth", truth_text(audit.truth));
  if (audit.depth_values.images() > 0) print_depth(out, audit);
  for (const std::string& warning : audit.warnings) out << "warning: " << warning << '\n';
  if (audit.warnings.empty()) out << "No problems found.\n";
  return out.str();
}

}  // namespace stillpoint::inspection
