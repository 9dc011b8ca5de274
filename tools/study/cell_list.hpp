// Cells in a file, for jobs that run one of them each on other machines.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "study/cell_runner.hpp"

namespace stillpoint::study {

/// A cell as it is written there, without its place in the study.
struct ListedCell {
  PlannedCell cell;
  std::string program;  ///< fingerprint of the build that planned it
};

/// One line each (JSON). Throws Error(kUsage) when it cannot be written.
void write_cells(const std::filesystem::path& file, const std::vector<ListedCell>& cells);

/// All of them. Throws Error(kData) when there is no such file, or a line is no cell.
std::vector<ListedCell> read_cells(const std::filesystem::path& file);

/// The cell of one line, counted from 0. Throws as read_cells does.
ListedCell read_cell(const std::filesystem::path& file, std::size_t line);

}  // namespace stillpoint::study
