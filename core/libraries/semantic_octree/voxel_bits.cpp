#include "semantic_octree/voxel_bits.hpp"

#include <algorithm>
#include <cmath>

namespace stillpoint::semantic_octree {
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

// Eight rays are always under way. Each lane has a part of the ends of its own: rays side by side
// would wait for each other's bytes.
class Marcher {
 public:
  Marcher(const VoxelBits& bits, const Eigen::Vector3f& origin,
          std::span<const VoxelBits::Index> ends)
      : bits_(bits),
        ends_(ends),
        origin_(origin),
        start_{static_cast<int>(origin.x()), static_cast<int>(origin.y()),
               static_cast<int>(origin.z())} {
    for (int lane = 0; lane < kLanes; ++lane) {
      following_[lane] = ends.size() * lane / kLanes;
      last_[lane] = ends.size() * (lane + 1) / kLanes;
      refill(lane);
    }
  }

  void run(std::uint8_t* bytes) {
    for (;;) {
      const std::int32_t steps = *std::min_element(left_.begin(), left_.end());
      if (steps > kMostSteps) return;
      march(rays_, steps, bytes);
      for (int lane = 0; lane < kLanes; ++lane)
        if ((left_[lane] -= steps) == 0) refill(lane);
    }
  }

 private:
  void refill(int lane) {
    while (left_[lane] == 0 && following_[lane] < last_[lane])
      begin_ray(lane, bits_.place(ends_[following_[lane]++]));
    if (left_[lane] > 0) return;
    for (Ints& step : rays_.step) step[lane] = 0;
    rays_.at[lane] = bits_.nowhere();
    left_[lane] = kIdle;
  }

  void begin_ray(int lane, const std::array<int, 3>& end) {
    const std::array<std::int32_t, 3> stride = {bits_.edge() * bits_.edge(), bits_.edge(), 1};
    for (int axis = 0; axis < 3; ++axis) {
      const float way = static_cast<float>(end[axis]) + 0.5F - origin_[axis];
      const float border = static_cast<float>(start_[axis] + (way > 0 ? 1 : 0));
      const float width = 1.0F / std::max(std::abs(way), 1e-6F);
      rays_.width[axis][lane] = width;
      rays_.next[axis][lane] = std::abs(border - origin_[axis]) * width;
      rays_.step[axis][lane] = way > 0 ? stride[axis] : -stride[axis];
      left_[lane] += std::abs(end[axis] - start_[axis]);
    }
    rays_.at[lane] = bits_.index(start_[0], start_[1], start_[2]);
  }

  const VoxelBits& bits_;
  std::span<const VoxelBits::Index> ends_;
  Eigen::Vector3f origin_;
  std::array<int, 3> start_;
  Rays rays_{};
  std::array<std::size_t, kLanes> following_{}, last_{};  // of each lane's ends
  std::array<std::int32_t, kLanes> left_{};               // steps
};

}  // namespace

void VoxelBits::set_rays(const Eigen::Vector3f& origin, std::span<const Index> ends) {
  Marcher(*this, origin, ends).run(bytes_.data());
}

}  // namespace stillpoint::semantic_octree
