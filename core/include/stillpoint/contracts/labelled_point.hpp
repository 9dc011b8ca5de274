// A point of a surface, with its colour and class.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace stillpoint {

struct LabelledPoint {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< metres, in world
  std::array<std::uint8_t, 3> rgb{};
  std::uint8_t label = 0;  ///< class id
  /// Of a cell of a map: the probability that it is occupied, 0 to 1; 1 where the map knows none.
  float occupancy = 1;
};

}  // namespace stillpoint
