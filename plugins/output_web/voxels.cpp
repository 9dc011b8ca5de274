#include "output_web/voxels.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace stillpoint::output_web {
namespace {

// Centres of the same cell are the same to the bit.
bool precedes(const LabelledPoint& a, const LabelledPoint& b) {
  const auto key = [](const LabelledPoint& point) {
    return std::tuple(point.position.x(), point.position.y(), point.position.z());
  };
  return key(a) < key(b);
}

/// Seen again, nearly every voxel's changes a little: sent is a change of this step only.
std::uint8_t occupancy_step(const LabelledPoint& voxel) {
  constexpr float kSteps = 15;
  return static_cast<std::uint8_t>(std::lround(kSteps * std::clamp(voxel.occupancy, 0.0F, 1.0F)));
}

bool look_alike(const LabelledPoint& a, const LabelledPoint& b) {
  return a.rgb == b.rgb && a.label == b.label && occupancy_step(a) == occupancy_step(b);
}

void write_position(const LabelledPoint& voxel, MessageWriter& writer) {
  for (const float value : voxel.position) writer.number(value);
}

void write(const Voxels& changed, const Voxels& removed, MessageWriter& writer) {
  writer.begin(Record::kVoxels);
  for (const LabelledPoint& voxel : changed) {
    write_position(voxel, writer);
    for (const std::uint8_t channel : voxel.rgb) writer.number(channel);
    writer.number(voxel.label);
    writer.number(occupancy_step(voxel));
  }
  writer.end();
  if (removed.empty()) return;
  writer.begin(Record::kVoxelsRemoved);
  for (const LabelledPoint& voxel : removed) write_position(voxel, writer);
  writer.end();
}

}  // namespace

VoxelsPtr sorted_voxels(std::vector<LabelledPoint> points) {
  std::ranges::sort(points, precedes);
  return std::make_shared<const Voxels>(std::move(points));
}

bool look_alike(const Voxels& a, const Voxels& b) {
  return std::ranges::equal(a, b, [](const LabelledPoint& one, const LabelledPoint& other) {
    return one.position == other.position && look_alike(one, other);
  });
}

VoxelsPtr write_voxel_changes(const VoxelsPtr& before, const VoxelsPtr& after, std::size_t limit,
                              MessageWriter& writer) {
  Voxels changed, removed, known;
  auto old = before->begin();
  auto now = after->begin();
  while ((old != before->end() || now != after->end()) && changed.size() + removed.size() < limit) {
    if (now == after->end() || (old != before->end() && precedes(*old, *now))) {
      removed.push_back(*old++);
      continue;
    }
    const bool is_new = old == before->end() || precedes(*now, *old);
    if (is_new || !look_alike(*now, *old)) changed.push_back(*now);
    if (!is_new) ++old;
    known.push_back(*now++);
  }
  write(changed, removed, writer);
  if (old == before->end() && now == after->end()) return after;
  known.insert(known.end(), old, before->end());
  return std::make_shared<const Voxels>(std::move(known));
}

}  // namespace stillpoint::output_web
