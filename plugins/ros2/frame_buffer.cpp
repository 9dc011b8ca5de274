#include "ros2/frame_buffer.hpp"

#include <algorithm>
#include <cmath>

namespace stillpoint::ros2 {
namespace {

constexpr double kKept = 10.0;      // seconds, as tf2 does
constexpr double kSameTime = 1e-6;  // seconds: a double of this century has 2e-7

}  // namespace

void FrameBuffer::add(const bag::TransformMessage& transform, Topic topic) {
  const double time = 1e-9 * static_cast<double>(transform.stamp);
  Link& link = links_[transform.child];
  const bool moves = topic == Topic::kTf;
  const bool begins_anew = link.parent != transform.parent || link.moves != moves || !moves ||
                           link.poses.back().time > time + kKept;  // a bag that is played again
  if (begins_anew) link = {transform.parent, moves, {}};
  if (!link.poses.empty() && time <= link.poses.back().time) return;  // repeated, or overtaken
  link.poses.push_back({time, transform.parent_from_child});
  while (link.poses.front().time < time - kKept) link.poses.pop_front();
}

std::optional<Pose> FrameBuffer::pose_at(const Link& link, std::optional<double> time) {
  if (!link.moves || !time) return link.poses.back().world_from_camera;
  const auto after = std::ranges::lower_bound(link.poses, *time, {}, &StampedPose::time);
  for (const auto& near : {after, after - (after == link.poses.begin() ? 0 : 1)})
    if (near != link.poses.end() && std::abs(near->time - *time) < kSameTime)
      return near->world_from_camera;
  if (after == link.poses.end() || after == link.poses.begin()) return std::nullopt;  // no guesses
  const StampedPose& before = *(after - 1);
  return interpolate(before.world_from_camera, after->world_from_camera,
                     (*time - before.time) / (after->time - before.time));
}

/// The frame itself, and all above it that are known at that time.
std::vector<FrameBuffer::Ancestor> FrameBuffer::ancestors_of(const std::string& frame,
                                                             std::optional<double> time) const {
  std::vector<Ancestor> all = {{.name = frame}};
  while (all.size() <= links_.size()) {  // more are a circle
    const auto link = links_.find(all.back().name);
    if (link == links_.end()) break;
    const auto parent_from_child = pose_at(link->second, time);
    if (!parent_from_child) break;
    all.push_back({link->second.parent, *parent_from_child * all.back().ancestor_from_frame});
  }
  return all;
}

std::optional<Pose> FrameBuffer::target_from_source(const std::string& target,
                                                    const std::string& source,
                                                    std::optional<double> time) const {
  const std::vector<Ancestor> above_target = ancestors_of(target, time);
  for (const Ancestor& common : ancestors_of(source, time)) {
    const auto same = std::ranges::find(above_target, common.name, &Ancestor::name);
    if (same != above_target.end())
      return same->ancestor_from_frame.inverse() * common.ancestor_from_frame;
  }
  return std::nullopt;
}

}  // namespace stillpoint::ros2
