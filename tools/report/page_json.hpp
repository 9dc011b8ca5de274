// What the page reads: JSON of a report, of one run, and a map's bytes.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "report/map_voxels.hpp"
#include "report/report_data.hpp"

namespace stillpoint::report {

/// Title, origins, notes, tables, and of each run what lists and comparisons show.
nlohmann::json report_json(const ReportData& data, const std::string& written_by);

/// Of one run: traces, errors, frames, times, options. Series have at most `points` entries.
nlohmann::json run_json(const RunData& run, std::size_t points);

/// What a map is; its cubes are in map_bytes().
nlohmann::json map_json(const MapVoxels& voxels);

/// x, y, z (16 bits, little-endian), red, green, blue, label, occupancy (8 bits): each of all
/// cubes.
std::string map_bytes(const MapVoxels& voxels);

}  // namespace stillpoint::report
