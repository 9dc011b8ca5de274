// What a stage is driven with: a usual recording, and cases that happen in the world and that
// authors forget.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "stillpoint/contracts/map_evidence.hpp"
#include "stillpoint/testing/test_recording.hpp"

namespace stillpoint::plugin_check {

/// All that any stage may be given for one frame.
struct Input {
  FramePtr frame;
  SegmentationPtr segmentation;
  MovingPoints moving;
  MapEvidence evidence;
  std::shared_ptr<const StaticWeights> weights;
  Pose world_from_camera = Pose::Identity();  ///< the truth
};

struct Scenario {
  std::string name;
  std::string why;     ///< it happens in the world
  std::string remedy;  ///< for a stage that fails on it
  std::string kind;    ///< of the stages that it is for; empty: all
  std::vector<Input> inputs;
  KeyFrameId first_keyframe = 0;  ///< its id
  bool is_usual = false;          ///< nothing is missing or odd: a map of it is not empty
  bool of_images = true;          ///< false: only labels, points and weights differ from the usual
  /// For trackers: from this input on, the map stays as it is.
  std::optional<std::size_t> localised_from = {};
  /// For outputs: a program gives the frames, and there is no begin().
  bool is_pushed = false;
  /// For loop closers: a RoundTrip instead of the inputs.
  bool is_round_trip = false;

  /// With features, weights and true pose.
  KeyFrame keyframe(std::size_t i, KeyFrameId id) const;
  DenseKeyFrame dense_keyframe(std::size_t i, KeyFrameId id) const;
};

/// The usual one first. Images of all frames are in read-only memory.
std::vector<Scenario> make_scenarios();

}  // namespace stillpoint::plugin_check
