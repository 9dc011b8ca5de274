// Ids are dense, given in order of creation, and never used again.
#pragma once

#include <cstdint>

namespace stillpoint {

using KeyFrameId = std::uint32_t;
using LandmarkId = std::uint32_t;

inline constexpr std::uint32_t kNoId = 0xffffffffu;  ///< "none", for every kind of id

}  // namespace stillpoint
