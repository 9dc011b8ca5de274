#include "semantic_octree/scan_bricks.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "stillpoint/error.hpp"

namespace stillpoint::semantic_octree {
namespace {

constexpr int kEdge = ScanBrick::kEdge;
constexpr int kKeyOfZero = 32768;  // OctoMap's key of the voxel that begins at 0
constexpr int kMargin = 2;         // voxels around what is within range
// The three bits of a coordinate with two zeros between them: a part of a Morton code.
constexpr std::array<unsigned, kEdge> kSpread = {0, 1, 8, 9, 64, 65, 72, 73};

unsigned code_in_brick(int x, int y, int z) {
  return kSpread[x % kEdge] | kSpread[y % kEdge] << 1U | kSpread[z % kEdge] << 2U;
}

std::uint64_t morton_code(const BrickKey& key) {
  std::uint64_t code = 0;
  for (unsigned bit = 0; bit < 16; ++bit)
    for (unsigned axis = 0; axis < 3; ++axis)
      code |= static_cast<std::uint64_t>(key[axis] >> bit & 1U) << (3 * bit + axis);
  return code;
}

// Four voxels along z as bits of a word in which x and y are 0.
constexpr std::array<std::uint64_t, 16> kFourAlongZ = [] {
  std::array<std::uint64_t, 16> words{};
  for (unsigned four = 0; four < 16; ++four)
    for (unsigned z = 0; z < 4; ++z)
      if (four >> z & 1U) words[four] |= std::uint64_t{1} << (kSpread[z] << 2U);
  return words;
}();

// Edge of the cube of bits, whose rows are whole words.
int cube_edge(int half) { return (2 * half + 2 * kEdge + 63) / 64 * 64; }

}  // namespace

ScanBricks::ScanBricks(const ScanOptions& options)
    : options_(options),
      half_(static_cast<int>(options.range / options.resolution) + kMargin + options.margin),
      ended_(cube_edge(half_)),
      passed_(cube_edge(half_)) {
  const auto bricks = static_cast<std::size_t>(ended_.edge() / kEdge);
  directory_.resize(bricks * bricks * bricks);
}

void ScanBricks::scan(const DenseKeyFrame& keyframe) {
  begin(keyframe);
  find_ends(keyframe);
  mark_beside_moving();
  if (options_.carve) {
    passed_.set_rays(origin_, ends_);
    add_passed();
  }
  finish();
}

void ScanBricks::begin(const DenseKeyFrame& keyframe) {
  const Eigen::Vector3d camera = keyframe.world_from_camera.translation() / options_.resolution;
  if (!keyframe.world_from_camera.matrix().allFinite() ||
      camera.cwiseAbs().maxCoeff() + half_ + 2 * kEdge >= kKeyOfZero)
    throw Error(Fault::kData, "a key frame is out of the octree's reach", {},
                "use a larger resolution");
  for (int axis = 0; axis < 3; ++axis) {
    const int key = static_cast<int>(std::floor(camera[axis])) + kKeyOfZero;
    corner_[axis] = (key - half_) / kEdge * kEdge;
    origin_[axis] = static_cast<float>(camera[axis] + kKeyOfZero - corner_[axis]);
  }
  ended_.clear();
  passed_.clear();
  std::fill(directory_.begin(), directory_.end(), -1);
  ends_.clear();
  moving_.clear();
  bricks_.clear();
  sums_.clear();
  sorted_.clear();
  observations_.clear();
  labelled_ = !keyframe.labels().empty();

  const Camera& camera_model = *keyframe.frame->camera;
  const auto width = static_cast<std::size_t>(keyframe.frame->depth.cols);
  row_.right.resize(width);
  row_.reach.resize(width);
  row_.voxel.resize(width);
  row_.front.resize(width);
  for (std::size_t u = 0; u < width; ++u)
    row_.right[u] =
        static_cast<float>((static_cast<double>(u) - camera_model.cx) / camera_model.fx);
}

void ScanBricks::find_ends(const DenseKeyFrame& keyframe) {
  const Frame& frame = *keyframe.frame;
  const cv::Mat labels = keyframe.labels(), weights = keyframe.map_weights();
  VoxelBits::Index last = -1, last_front = -1;  // neighbours share their voxels
  Sum* sum = nullptr;
  for (int v = 0; v < frame.depth.rows; ++v) {
    find_voxels(keyframe.world_from_camera, frame, v);
    const auto* depth = frame.depth.ptr<float>(v);
    const auto* bgr = frame.bgr.ptr<std::uint8_t>(v);
    const auto* label = labels.empty() ? nullptr : labels.ptr<std::uint8_t>(v);
    const auto* weight = weights.empty() ? nullptr : weights.ptr<std::uint8_t>(v);
    for (int u = 0; u < frame.depth.cols; ++u) {
      if (!(depth[u] > 0)) continue;
      const VoxelBits::Index voxel = row_.voxel[u];
      if (voxel != last) {
        last = voxel;
        sum = nullptr;
      }
      if (const VoxelBits::Index front = row_.front[u]; front != last_front) {
        last_front = front;
        if (!ended_.set(front)) ends_.push_back(front);
      }
      if (depth[u] > row_.reach[u]) continue;
      if (weight && weight[u] < options_.min_weight) {
        if (moving_.empty() || moving_.back() != voxel) moving_.push_back(voxel);
        continue;
      }
      if (!sum) sum = &sum_of(voxel);
      sum->add(bgr + 3 * u, label ? label[u] : std::uint8_t{0});
    }
  }
}

// Rays longer than the range end there.
void ScanBricks::find_voxels(const Pose& world_from_camera, const Frame& frame, int v) {
  const Eigen::Matrix3f turn = (world_from_camera.linear() / options_.resolution).cast<float>();
  const auto down = static_cast<float>((v - frame.camera->cy) / frame.camera->fy);
  const Eigen::Vector3f middle = down * turn.col(1) + turn.col(2);
  const Eigen::Vector3f right = turn.col(0);
  const Eigen::Vector3f origin = origin_;
  const auto range = static_cast<float>(options_.range);
  const auto margin =
      static_cast<float>(options_.sigmas_before_surface * frame.camera->surface_noise);
  const float rest = down * down + 1;
  const int edge = ended_.edge();
  const auto* depth = frame.depth.ptr<float>(v);
  for (int u = 0; u < frame.depth.cols; ++u) {
    const float x = row_.right[u];
    const float reach = range / std::sqrt(x * x + rest);
    const float z = depth[u] < reach ? depth[u] : reach;
    const auto voxel_at = [&](float along) {
      const auto at_x =
          static_cast<std::int32_t>(origin.x() + along * (middle.x() + x * right.x()));
      const auto at_y =
          static_cast<std::int32_t>(origin.y() + along * (middle.y() + x * right.y()));
      const auto at_z =
          static_cast<std::int32_t>(origin.z() + along * (middle.z() + x * right.z()));
      return (at_x * edge + at_y) * edge + at_z;
    };
    row_.reach[u] = reach;
    row_.voxel[u] = voxel_at(z);
    const float before = depth[u] - std::min(margin * depth[u] * depth[u], depth[u]);
    row_.front[u] = voxel_at(before < reach ? before : reach);
  }
}

ScanBricks::Sum& ScanBricks::sum_of(VoxelBits::Index voxel) {
  const auto [x, y, z] = ended_.place(voxel);
  ScanBrick& brick = brick_at(x, y, z);
  if (brick.sums < 0) {
    brick.sums = static_cast<std::int32_t>(sums_.size());
    sums_.emplace_back();
  }
  const unsigned code = code_in_brick(x, y, z);
  brick.hit[code / 64] |= std::uint64_t{1} << (code % 64);
  return sums_[brick.sums][code];
}

void ScanBricks::Sum::add(const std::uint8_t* bgr, std::uint8_t seen) {
  constexpr int kMostPixels = 255;  // as many as fit into the sums
  if (pixels < kMostPixels) {
    ++pixels;
    for (int i = 0; i < 3; ++i) rgb[i] = static_cast<std::uint16_t>(rgb[i] + bgr[2 - i]);
  }
  label.add(seen);
}

VoxelObservation ScanBricks::Sum::observation(bool labelled) const {
  VoxelObservation observation{
      .label = label.winner, .labelled = labelled, .beside_moving = beside_moving};
  for (int i = 0; i < 3; ++i) observation.rgb[i] = static_cast<std::uint8_t>(rgb[i] / pixels);
  return observation;
}

ScanBrick& ScanBricks::brick_at(int x, int y, int z) {
  const std::array<int, 3> place = {x / kEdge, y / kEdge, z / kEdge};
  const int bricks = ended_.edge() / kEdge;
  std::int32_t& index = directory_[(place[0] * bricks + place[1]) * bricks + place[2]];
  if (index < 0) {
    index = static_cast<std::int32_t>(bricks_.size());
    ScanBrick& brick = bricks_.emplace_back();
    for (int axis = 0; axis < 3; ++axis)
      brick.key[axis] = static_cast<std::uint16_t>(corner_[axis] / kEdge + place[axis]);
  }
  return bricks_[index];
}

void ScanBricks::mark_beside_moving() {
  const int margin = options_.margin, bricks = ended_.edge() / kEdge;
  if (margin == 0) return;
  for (const VoxelBits::Index voxel : moving_) {
    const auto [x, y, z] = ended_.place(voxel);
    for (int near_x = x - margin; near_x <= x + margin; ++near_x)
      for (int near_y = y - margin; near_y <= y + margin; ++near_y)
        for (int near_z = z - margin; near_z <= z + margin; ++near_z) {
          const std::int32_t brick =
              directory_[(near_x / kEdge * bricks + near_y / kEdge) * bricks + near_z / kEdge];
          if (brick >= 0 && bricks_[brick].sums >= 0)
            sums_[bricks_[brick].sums][code_in_brick(near_x, near_y, near_z)].beside_moving = true;
        }
  }
}

// From rows of bits to the Morton codes of bricks.
void ScanBricks::add_passed() {
  const int edge = passed_.edge();
  for (int x = 0; x < edge; ++x)
    for (int y = 0; y < edge; ++y)
      for (int z = 0; z < edge; z += 64)
        for (std::uint64_t left = passed_.word(passed_.index(x, y, z)); left != 0;) {
          const int eighth = std::countr_zero(left) / kEdge;
          const unsigned eight = left >> (kEdge * eighth) & 0xFFU;
          left &= ~(std::uint64_t{0xFF} << (kEdge * eighth));
          ScanBrick& brick = brick_at(x, y, z + kEdge * eighth);
          const unsigned code = code_in_brick(x, y, 0);
          brick.passed[code / 64] |= kFourAlongZ[eight % 16] << (code % 64);
          brick.passed[code / 64 + 4] |= kFourAlongZ[eight / 16] << (code % 64);
        }
}

void ScanBricks::finish() {
  std::vector<std::pair<std::uint64_t, const ScanBrick*>> order;
  order.reserve(bricks_.size());
  for (ScanBrick& brick : bricks_) {
    brick.first_observation = static_cast<std::uint32_t>(observations_.size());
    for (unsigned word = 0; word < brick.hit.size(); ++word) {
      brick.passed[word] &= ~brick.hit[word];
      for (std::uint64_t left = brick.hit[word]; left != 0; left &= left - 1)
        observations_.push_back(
            sums_[brick.sums][64 * word + std::countr_zero(left)].observation(labelled_));
    }
    order.emplace_back(morton_code(brick.key), &brick);
  }
  std::sort(order.begin(), order.end());
  for (const auto& [code, brick] : order) sorted_.push_back(brick);
}

}  // namespace stillpoint::semantic_octree
