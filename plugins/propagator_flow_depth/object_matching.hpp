// Data association of objects found by the network with tracked objects.
#pragma once

#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "propagator_flow_depth/followed_object.hpp"
#include "propagator_flow_depth/found_objects.hpp"

namespace stillpoint::propagator_flow_depth {

/// What was found in a view, and what was followed there.
struct MatchInput {
  std::span<const FoundObject> found;
  const cv::Mat& found_instances;  ///< CV_8UC1, 1 + index into `found`; of a view's size
  std::span<const FollowedObject> followed;
  const cv::Mat& followed_instances;  ///< CV_8UC1, 1 + index into `followed_ids`; may be empty
  std::span<const int> followed_ids;
};

struct Matches {
  std::vector<int> followed_of;  ///< per found object: index into `followed`, -1 = new
  std::vector<bool> covered;     ///< per followed object: found ones of its class cover most of it
};

/// Greedy matching of objects of one class whose masks overlap and whose depths agree, largest
/// overlaps first.
Matches match_objects(const MatchInput& input);

}  // namespace stillpoint::propagator_flow_depth
