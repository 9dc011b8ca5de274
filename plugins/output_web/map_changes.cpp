#include "output_web/map_changes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace stillpoint::output_web {
namespace {

constexpr double kLogOddsSteps = 8;  // of a landmark's byte, per unit

enum class Presence : std::uint8_t { kRemoved, kPresent, kCleared };

void write_keyframe(const KeyFrame& keyframe, MessageWriter& writer) {
  writer.number(keyframe.id);
  writer.number(static_cast<std::uint8_t>(Presence::kPresent));
  writer.pose(keyframe.world_from_camera);
  writer.number(keyframe.frame);
  writer.number(keyframe.parent);
  const std::size_t count = writer.count();
  std::size_t edges = 0;
  for (const Covisibility& other : keyframe.covisible) {
    if (other.keyframe >= keyframe.id) continue;  // each edge once
    writer.number(other.keyframe);
    writer.number(static_cast<std::uint16_t>(
        std::min(other.shared, int{std::numeric_limits<std::uint16_t>::max()})));
    ++edges;
  }
  writer.set_count(count, edges);
}

// Frames may refer to it: it moves with the key frame under which it was removed, if any.
void write_absent(KeyFrameId id, Presence presence, const Pose& world_from_camera,
                  MessageWriter& writer) {
  writer.number(id);
  writer.number(static_cast<std::uint8_t>(presence));
  writer.pose(world_from_camera);
}

bool write_if_changed(KeyFrameId id, const SparseMap& before, const SparseMap& after,
                      MessageWriter& writer) {
  if (id < before.keyframe_id_begin()) return false;
  const KeyFrame* old = before.keyframe(id);
  if (const KeyFrame* keyframe = after.keyframe(id)) {
    if (keyframe == old) return false;
    write_keyframe(*keyframe, writer);
    return true;
  }
  const Pose pose = after.world_from_keyframe(id);
  if (id < after.keyframe_id_begin()) {
    write_absent(id, Presence::kCleared, pose, writer);
    return true;
  }
  if (!old && id < before.keyframe_id_end() && pose.isApprox(before.world_from_keyframe(id)))
    return false;
  write_absent(id, Presence::kRemoved, pose, writer);
  return true;
}

void write_landmark(const Landmark& landmark, MessageWriter& writer) {
  writer.number(landmark.id);
  writer.point(landmark.position_in_world);
  writer.number(static_cast<std::int8_t>(
      std::clamp(kLogOddsSteps * double{landmark.static_log_odds}, -127.0, 127.0)));
  writer.number(
      static_cast<std::uint8_t>(std::min<std::size_t>(landmark.observations.size(), 255)));
}

bool shows_the_same(const Landmark& a, const Landmark& b) {
  return a.position_in_world == b.position_in_world && a.static_log_odds == b.static_log_odds &&
         a.observations.size() == b.observations.size();
}

// Those that are gone have no observations.
bool write_if_changed(LandmarkId id, const Landmark* old, const Landmark* landmark,
                      MessageWriter& writer) {
  if (landmark == old) return false;
  if (landmark && old && shows_the_same(*landmark, *old)) return false;
  if (landmark)
    write_landmark(*landmark, writer);
  else
    write_landmark({.id = id}, writer);
  return true;
}

/// From `id` on, which is then the first that is left, while the message is below `full` bytes.
template <class Id, class WriteIfChanged>
void write_list(Record kind, Id& id, std::size_t id_end, std::size_t full, MessageWriter& writer,
                WriteIfChanged write_if_changed) {
  writer.begin(kind);
  const std::size_t place = writer.count();
  std::size_t count = 0;
  for (; id < id_end && writer.size() < full; ++id)
    if (write_if_changed(id)) ++count;
  writer.set_count(place, count);
  writer.end();
}

}  // namespace

void write_map_changes(SeenMap& seen, const MapPtr& now, std::size_t limit, MessageWriter& writer) {
  if (!seen.next) seen.next = now;
  const SparseMap &before = *seen.whole, &after = *seen.next;
  const std::size_t full = writer.size() + limit;
  write_list(Record::kKeyFrames, seen.keyframes, after.keyframe_id_end(), full, writer,
             [&](KeyFrameId id) { return write_if_changed(id, before, after, writer); });
  write_list(Record::kLandmarks, seen.landmarks, after.landmark_id_end(), full, writer,
             [&](LandmarkId id) {
               return write_if_changed(id, before.landmark(id), after.landmark(id), writer);
             });
  if (seen.keyframes == after.keyframe_id_end() && seen.landmarks == after.landmark_id_end())
    seen = {.whole = std::move(seen.next)};
}

}  // namespace stillpoint::output_web
