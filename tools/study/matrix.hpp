// The cells of a study: sequences × variants × repeats.
#pragma once

#include <compare>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "study/study.hpp"

namespace stillpoint::study {

struct Cell {
  std::size_t sequence = 0;  ///< index into the study's
  std::size_t variant = 0;   ///< index into the study's
  int repeat = 0;

  auto operator<=>(const Cell&) const = default;
};

/// By sequence, then variant, then repeat; without what `only` and `skip` leave out.
std::vector<Cell> cells_of(const Study& study);

/// Whether the variant is to run on the sequence.
bool is_wanted(const Variant& variant, const std::string& sequence);

/// "SEQUENCE/VARIANT/REPEAT", also the cell's folder below `runs`.
std::string name_of(const Study& study, const Cell& cell);
std::filesystem::path run_folder(const std::filesystem::path& output, const Study& study,
                                 const Cell& cell);

/// Where the recording of a sequence lies, or will, for one of the repeats. Sequences with the same
/// images share it.
std::filesystem::path recording_of(const std::filesystem::path& output, const Study& study,
                                   std::size_t sequence, int repeat);

}  // namespace stillpoint::study
