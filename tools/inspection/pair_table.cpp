#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "inspection/number_text.hpp"
#include "inspection/pair_report.hpp"
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

std::string range_text(const PairAudit& audit) {
  const auto metres = [&](double share) {
    return fixed(audit.depth_values.quantile(share) / audit.depth_factor, 2) + " m";
  };
  return "5 % nearer than " + metres(0.05) + ", half than " + metres(0.5) + ", 95 % than " +
         metres(0.95) + " (factor " + fixed(audit.depth_factor, 0) +
         (audit.camera ? ")" : " assumed; name the camera with --camera)");
}

/// Edges of the bins, in metres; the last is that of the largest depth there is.
constexpr double kEdges[] = {0, 0.5, 1, 1.5, 2, 3, 4, 6, 10, 1e6};
constexpr std::size_t kBins = std::size(kEdges) - 1;

/// Fourteen columns wide.
std::string bin_text(std::size_t bin) {
  const std::string from = fixed(kEdges[bin], 1) + " ";
  if (bin + 1 == kBins) return right(from + "m and up", 14);
  return right(from, 6) + "– " + right(fixed(kEdges[bin + 1], 1) + " m", 6);
}

void print_histogram(std::ostream& out, const PairAudit& audit) {
  constexpr double kBarLength = 40;
  std::array<double, kBins> shares{};
  for (std::size_t i = 0; i < kBins; ++i)
    shares[i] = audit.depth_values.share_between(kEdges[i], kEdges[i + 1], audit.depth_factor);
  const double largest = std::max(1e-9, *std::ranges::max_element(shares));
  for (std::size_t i = 0; i < kBins; ++i) {
    const long blocks = std::lround(kBarLength * shares[i] / largest);
    out << "    " << bin_text(i) << right(percent(shares[i]), 10) << (blocks > 0 ? "  " : "");
    for (long k = 0; k < blocks; ++k) out << "█";
    out << '\n';
  }
}

}  // namespace

void print_streams(std::ostream& out, const PairAudit& audit, const std::string& color,
                   const std::string& depth, const std::string& paired_by) {
  const double start = audit.color.begin;
  row(out, "colour", color + stream_text(audit.color, start));
  row(out, "depth", depth + stream_text(audit.depth, start));
  row(out, "pairs", stream_text(audit.pairs, start) + "; " + paired_by);
  row(out, "unpaired",
      std::to_string(audit.color.images - audit.pairs.images) + " colour, " +
          std::to_string(audit.depth.images - audit.pairs.images) + " depth");
  row(out, "stamps of a pair",
      "differ by " + milliseconds(audit.mean_difference, 1) + " on average, " +
          milliseconds(audit.max_difference, 1) + " at most");
}

void print_images(std::ostream& out, const PairAudit& audit) {
  row(out, "colour images", counts_text(audit.color_kinds));
  row(out, "depth images",
      counts_text(audit.depth_kinds) + " (" + std::to_string(audit.sampled) + " pairs sampled)");
  if (!audit.unreadable.empty())
    row(out, "damaged images", std::to_string(audit.unreadable.size()) + " of those sampled");
  row(out, "time offset", offset_text(audit.time_offset));
}

void print_depth(std::ostream& out, const PairAudit& audit) {
  if (audit.depth_values.images() == 0) return;
  row(out, "valid depth", percent(audit.depth_values.valid_share()) + " of the pixels");
  row(out, "depth range", range_text(audit));
  print_histogram(out, audit);
}

void print_warnings(std::ostream& out, const PairAudit& audit) {
  for (const std::string& warning : audit.warnings) out << "warning: " << warning << '\n';
  if (audit.warnings.empty()) out << "No problems found.\n";
}

}  // namespace stillpoint::inspection
