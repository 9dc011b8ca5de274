#include "bag/frame_tree.hpp"

#include <algorithm>
#include <iterator>
#include <unordered_map>

namespace stillpoint::bag {
namespace {

bool is_of_tf(const Topic& topic) {
  return topic.serialisation != Serialisation::kOther &&
         std::ranges::find(kTransformTypes, topic.type) != std::end(kTransformTypes);
}

/// ROS 1 repeats transforms that stand still, from the same numbers.
bool differ(const Pose& a, const Pose& b) {
  constexpr double kStill = 1e-3;  // metres and radians
  return log_se3(a.inverse() * b).cwiseAbs().maxCoeff() > kStill;
}

}  // namespace

FrameTree::FrameTree(BagReader& bag) {
  for (const MessagePlace& place : bag.messages()) {
    const Topic& topic = bag.topics()[place.topic];
    if (!is_of_tf(topic)) continue;
    try {
      for (const TransformMessage& transform :
           read_transforms(bag.read(place), topic.serialisation))
        add(transform);
    } catch (const Error&) {  // a damaged message
    }
  }
}

void FrameTree::add(const TransformMessage& transform) {
  const auto [found, is_new] = links_.try_emplace(
      transform.child, Link{transform.parent, transform.parent_from_child, false});
  Link& link = found->second;
  if (!is_new && link.parent == transform.parent)
    link.moves |= differ(link.parent_from_child, transform.parent_from_child);
}

/// The frame itself, and all above it.
std::vector<FrameTree::Ancestor> FrameTree::ancestors_of(const std::string& frame) const {
  std::vector<Ancestor> all = {{.name = frame}};
  while (all.size() <= links_.size()) {  // more are a circle
    const auto link = links_.find(all.back().name);
    if (link == links_.end()) break;
    const auto& [parent, parent_from_child, moves] = link->second;
    all.push_back(
        {parent, parent_from_child * all.back().ancestor_from_frame, all.back().moves || moves});
  }
  return all;
}

Pose FrameTree::target_from_source(const std::string& target, const std::string& source) const {
  std::unordered_map<std::string, Ancestor> above_source;
  for (const Ancestor& ancestor : ancestors_of(source))
    above_source.try_emplace(ancestor.name, ancestor);
  for (const Ancestor& common : ancestors_of(target)) {
    const auto found = above_source.find(common.name);
    if (found == above_source.end()) continue;
    if (common.moves || found->second.moves)
      throw Error(Fault::kUsage, "by tf, '" + source + "' moves against '" + target + "'");
    return common.ancestor_from_frame.inverse() * found->second.ancestor_from_frame;
  }
  throw Error(Fault::kUsage, "tf does not say how '" + source + "' lies to '" + target + "'");
}

}  // namespace stillpoint::bag
