#include "map_octomap/voxel_bits.hpp"

#include <algorithm>
#include <cmath>

namespace stillpoint {
namespace {

constexpr int kLanes = 8;                      // rays at once
constexpr std::int32_t kIdle = 2'000'000'000;  // steps, of a lane without rays
constexpr std::int32_t kMostSteps = 1'000'000'000;
using Floats = float __attribute__((vector_size(4 * kLanes)));
using Ints = std::int32_t __attribute__((vector_size(4 * kLanes)));

// Rays on their way. `next` and `width` are in lengths of the ray: how far the next border is along
// each axis, and how far borders are apart.
struct Rays {
  Floats next[3];
  Floats width[3];
  Ints step[3];
  Ints at;
};

// Sets the bits of all rays and goes on, as often as `steps` says.
__attribute__((target_clones("avx2", "default"))) void march(Rays& rays, std::int32_t steps,
                                                             std::uint8_t* bytes) {
  Floats x = rays.next[0], y = rays.next[1], z = rays.next[2];
  Ints at = rays.at;
  for (; steps > 0; --steps) {
    for (int i = 0; i < kLanes; ++i) {
      const auto place = static_cast<std::uint32_t>(at[i]);
      bytes[place / 8] = static_cast<std::uint8_t>(bytes[place / 8] | 1U << (place % 8));
    }
    const Ints along_x = (x < y) & (x < z);
    const Ints along_y = ~along_x & (y < z);
    const Ints along_z = ~(along_x | along_y);
    x += along_x ? rays.width[0] : Floats{};
    y += along_y ? rays.width[1] : Floats{};
    z += along_z ? rays.width[2] : Floats{};
    at += (rays.step[0] & along_x) | (rays.step[1] & along_y) | (rays.step[2] & along_z);
  }
  rays.next[0] = x;
  rays.next[1] = y;
  rays.next[2] = z;
  rays.at = at;
}

}  // namespace

void VoxelBits::set_rays(const Eigen::Vector3f& origin, std::span<const Index> ends) {
  const std::array<int, 3> start = {static_cast<int>(origin.x()), static_cast<int>(origin.y()),
                                    static_cast<int>(origin.z())};
  const std::array<std::int32_t, 3> stride = {edge_ * edge_, edge_, 1};
  const Index nowhere = stride[0] * edge_;
  Rays rays{};
  // Each lane has a part of the ends of its own: rays side by side would wait for each other's
  // bytes.
  std::array<std::size_t, kLanes> following{}, last{};
  std::array<std::int32_t, kLanes> left{};  // steps
  const auto begin_ray = [&](int lane, const std::array<int, 3>& end) {
    for (int axis = 0; axis < 3; ++axis) {
      const float way = static_cast<float>(end[axis]) + 0.5F - origin[axis];
      const float border = static_cast<float>(start[axis] + (way > 0 ? 1 : 0));
      const float width = 1.0F / std::max(std::abs(way), 1e-6F);
      rays.width[axis][lane] = width;
      rays.next[axis][lane] = std::abs(border - origin[axis]) * width;
      rays.step[axis][lane] = way > 0 ? stride[axis] : -stride[axis];
      left[lane] += std::abs(end[axis] - start[axis]);
    }
    rays.at[lane] = index(start[0], start[1], start[2]);
  };
  const auto refill = [&](int lane) {
    while (left[lane] == 0 && following[lane] < last[lane])
      begin_ray(lane, place(ends[following[lane]++]));
    if (left[lane] > 0) return;
    for (Ints& step : rays.step) step[lane] = 0;
    rays.at[lane] = nowhere;
    left[lane] = kIdle;
  };
  for (int lane = 0; lane < kLanes; ++lane) {
    following[lane] = ends.size() * lane / kLanes;
    last[lane] = ends.size() * (lane + 1) / kLanes;
    refill(lane);
  }
  for (;;) {
    const std::int32_t steps = *std::min_element(left.begin(), left.end());
    if (steps > kMostSteps) return;
    march(rays, steps, bytes_.data());
    for (int lane = 0; lane < kLanes; ++lane)
      if ((left[lane] -= steps) == 0) refill(lane);
  }
}

}  // namespace stillpoint
