// A sparse map from a file.
#pragma once

#include <filesystem>
#include <stdexcept>

#include "stillpoint/contracts/sparse_map.hpp"

namespace stillpoint {

/// Something in a map's file cannot be.
class DamagedMap : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Never changes the file. Throws DamagedMap or SqliteFault.
SparseMap read_map(const std::filesystem::path& file);

}  // namespace stillpoint
