// In what two pipelines differ, option by option.
#pragma once

#include <string>
#include <vector>

#include "report/report_data.hpp"

namespace stillpoint::report {

/// Of effective pipelines as YAML, in the order of `yaml`, what only the base has last. Where the
/// recording lies and the seed are no differences. Throws Error(kData) for what is no YAML.
std::vector<OptionChange> option_changes(const std::string& base, const std::string& yaml);

/// The folder of the recording that a pipeline reads; empty: it reads none, or cannot be read.
std::string recording_of_pipeline(const std::string& yaml);

/// The page that an output `web` of the pipeline records; empty: none, or it cannot be read.
std::string live_view_of_pipeline(const std::string& yaml);

}  // namespace stillpoint::report
