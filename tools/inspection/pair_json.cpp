#include "inspection/pair_report.hpp"

namespace stillpoint::inspection {
namespace {

using Json = nlohmann::ordered_json;

Json stream_json(const StreamAudit& stream) {
  Json gaps = Json::array();
  for (const Gap& gap : stream.gaps) gaps.push_back({{"begin", gap.begin}, {"length", gap.length}});
  return {{"images", stream.images},
          {"begin", stream.begin},
          {"duration", stream.duration},
          {"interval", stream.interval},
          {"gaps", gaps}};
}

Json depth_json(const PairAudit& audit) {
  const DepthStatistics& depth = audit.depth_values;
  Json histogram = Json::array();
  constexpr double kBin = 0.5;  // metres
  for (int i = 0; i < 20; ++i)
    histogram.push_back(depth.share_between(kBin * i, kBin * (i + 1), audit.depth_factor));
  return {{"factor", audit.depth_factor},
          {"factor_assumed", !audit.camera.has_value()},
          {"valid_share", depth.valid_share()},
          {"images_without_measurement", depth.empty_images()},
          {"q05", depth.quantile(0.05) / audit.depth_factor},
          {"median", depth.quantile(0.5) / audit.depth_factor},
          {"q95", depth.quantile(0.95) / audit.depth_factor},
          {"histogram_bin", kBin},
          {"histogram", histogram}};
}

Json offset_json(const TimeOffset& offset) {
  if (!offset.known) return {{"known", false}, {"reason", offset.reason}};
  return {{"known", true},
          {"offset", offset.offset},
          {"deviation", offset.deviation},
          {"correlation", offset.correlation}};
}

}  // namespace

Json pair_json(const PairAudit& audit) {
  return {{"color", stream_json(audit.color)},
          {"depth", stream_json(audit.depth)},
          {"pairs", stream_json(audit.pairs)},
          {"mean_difference", audit.mean_difference},
          {"max_difference", audit.max_difference},
          {"sampled_pairs", audit.sampled},
          {"color_images", audit.color_kinds},
          {"depth_images", audit.depth_kinds},
          {"unusable_images", audit.unreadable},
          {"depth_values", depth_json(audit)},
          {"time_offset", offset_json(audit.time_offset)}};
}

}  // namespace stillpoint::inspection
