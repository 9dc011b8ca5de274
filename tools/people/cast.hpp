// Everybody and everything that is pasted into one recording.
#pragma once

#include <filesystem>
#include <vector>

#include "people/base_recording.hpp"
#include "people/composition.hpp"
#include "people/figure.hpp"
#include "people/photographs.hpp"
#include "people/thing.hpp"

namespace stillpoint::people {

/// Where the people and the pictures on things come from.
struct Sources {
  std::vector<PersonPhoto> people;              ///< held_out_people()
  std::vector<std::filesystem::path> pictures;  ///< for the sides of things
};

class Cast {
 public:
  /// Chooses photographs at random, and matches their lighting to the recording. Throws
  /// Error(kData) when there are too few photographs.
  Cast(const RecordingPlan& plan, const BaseRecording& base, const Sources& sources);

  /// All layers, the people first, at a time of the base (s), as the exposure of a colour image
  /// smears them.
  std::vector<Layer> seen_at(double time) const;
  /// Sharp, and without colours.
  std::vector<Layer> shapes_at(double time) const;

  std::size_t people() const { return figures_.size(); }

 private:
  void light_figures(const RecordingPlan& plan);
  Pose level_from_camera(double time) const;

  const BaseRecording& base_;
  double start_;  // s
  Pose level_from_world_;
  std::vector<Figure> figures_;
  std::vector<Thing> things_;
};

/// The pairs that a recording takes of its base.
std::vector<BasePair> pairs_of(const RecordingPlan& plan, const BaseRecording& base);

}  // namespace stillpoint::people
