// The page: a template with everything that it shows inside.
#pragma once

#include <filesystem>
#include <string>

#include "report/report_data.hpp"

namespace stillpoint::report {

/// How much of a report's runs goes into its page, so that it stays below 20 MB up to 300 runs.
struct PageLimits {
  std::size_t points = 2000;              ///< of a series; with many runs fewer
  std::size_t voxels = 250'000;           ///< of a map
  std::size_t map_bytes = 5'000'000;      ///< of all maps; what comes after is left out
  std::size_t picture_bytes = 3'000'000;  ///< of all pictures before base64, likewise
  std::size_t replay_bytes = 6'000'000;   ///< of all recorded live views, likewise
};

/// `page` is the built template; `folder` is where the filled one will lie, for recordings of live
/// views that are too large for it; `written_by` names the program. What is left out is said in the
/// page. Throws Error(kUsage) when the template cannot be used.
std::string filled_page(const std::filesystem::path& page, const ReportData& data,
                        const std::filesystem::path& folder, const std::string& written_by,
                        const PageLimits& limits = {});

}  // namespace stillpoint::report
