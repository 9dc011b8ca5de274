// A sparse map from a file.
#pragma once

#include <filesystem>
#include <stdexcept>

#include "stillpoint/contracts/sparse_map.hpp"

namespace stillpoint {

/// The file of a map is damaged or holds impossible values.
class DamagedMap : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Never changes the file. Throws DamagedMap or SqliteFault.
SparseMap read_map(const std::filesystem::path& file);

}  // namespace stillpoint
