#include "stillpoint/engine/pipeline_warnings.hpp"

#include "stillpoint/support/did_you_mean.hpp"

namespace stillpoint {
namespace {

/// Of those whose results reach tracking by a decision only.
std::vector<std::string> sections_without_effect(const PipelineConfig& config) {
  std::vector<std::string> sections;
  if (config.decision) return sections;
  for (const auto* stage : {&config.segmenter, &config.moving_checker, &config.map_checker})
    if (*stage) sections.push_back((*stage)->section());
  return sections;
}

}  // namespace

std::vector<std::string> warnings_of(const PipelineConfig& config) {
  std::vector<std::string> warnings = config.warnings;
  if (const std::vector<std::string> sections = sections_without_effect(config); !sections.empty())
    warnings.push_back("there is no decision, so that tracking does not use: " + join(sections) +
                       "; 'decision: {type: bayes}' weighs what they find");
  const bool latest = config.segmentation.schedule == SegmentationOptions::Schedule::kLatest;
  if (latest && config.segmenter && !config.propagator)
    warnings.emplace_back(
        "schedule 'latest' without a propagator: labels of earlier frames are used where they "
        "were in those; 'propagator: {type: flow_depth}' moves them to the current frame");
  if (!latest && config.segmentation.interval_seconds > 0)
    warnings.emplace_back(
        "segmentation.interval_seconds means nothing with schedule 'wait': every frame is "
        "segmented");
  return warnings;
}

}  // namespace stillpoint
