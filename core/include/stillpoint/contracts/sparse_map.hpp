// The sparse map as a value (architecture: one thread writes new versions, all others read).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "stillpoint/contracts/keyframe.hpp"
#include "stillpoint/contracts/landmark.hpp"
#include "stillpoint/export.hpp"

namespace stillpoint {

/// Key frames and landmarks by id. Copying copies pointers only; the elements are constant and
/// shared between versions. New versions are made with MapEdit. Safe to read from any thread.
class STILLPOINT_EXPORT SparseMap {
 public:
  bool empty() const { return keyframe_count_ == 0; }

  /// Of the oldest key frame, which is never removed; ids below are of a map that was cleared.
  /// Equal to keyframe_id_end() while the map is empty.
  KeyFrameId keyframe_id_begin() const { return keyframe_id_begin_; }
  /// One past the largest id ever given, removed elements included.
  std::size_t keyframe_id_end() const { return keyframes_.size(); }
  std::size_t landmark_id_end() const { return landmarks_.size(); }
  /// Elements that are there.
  std::size_t keyframe_count() const { return keyframe_count_; }
  std::size_t landmark_count() const { return landmark_count_; }

  /// Null when it was removed or never existed; kNoId is allowed.
  const KeyFrame* keyframe(KeyFrameId id) const {
    return id < keyframes_.size() ? keyframes_[id].get() : nullptr;
  }
  const Landmark* landmark(LandmarkId id) const {
    return id < landmarks_.size() ? landmarks_[id].get() : nullptr;
  }
  /// For those who keep an element longer than the map.
  std::shared_ptr<const KeyFrame> shared_keyframe(KeyFrameId id) const {
    return id < keyframes_.size() ? keyframes_[id] : nullptr;
  }

  /// The landmark that took over the observations of a fused one, itself while it exists, or kNoId.
  LandmarkId current_id(LandmarkId id) const;

  /// Pose of a key frame, also of a removed one: it moves with the key frame it was removed under.
  /// The id must be below keyframe_id_end(). Below keyframe_id_begin(): where it was in the map
  /// that was cleared, which says nothing about this one.
  Pose world_from_keyframe(KeyFrameId id) const;

  /// Verifies both directions of every observation, the covisibility graph and the spanning tree.
  /// Returns the first inconsistency in words, or nothing. For tests.
  std::optional<std::string> check() const;

 private:
  friend class MapEdit;

  struct RemovedKeyFrame {
    KeyFrameId parent = kNoId;  // none: of a map that was cleared
    Pose parent_from_keyframe = Pose::Identity();
  };

  std::vector<std::shared_ptr<const KeyFrame>> keyframes_;
  std::vector<std::shared_ptr<const Landmark>> landmarks_;
  std::vector<std::shared_ptr<const RemovedKeyFrame>> removed_;  // by key frame id, null = present
  std::vector<LandmarkId> successor_;  // by landmark id, kNoId = not fused
  std::size_t keyframe_count_ = 0;
  std::size_t landmark_count_ = 0;
  KeyFrameId keyframe_id_begin_ = 0;
};

/// Makes the next version of a map: elements are cloned when first changed, so that every copy
/// others hold stays as it is. Keeps observations of key frames and landmarks consistent. Throws
/// Error(kStage) for ids and features that are not there.
class STILLPOINT_EXPORT MapEdit {
 public:
  explicit MapEdit(SparseMap map);

  /// The map as edited so far.
  const SparseMap& map() const { return map_; }

  /// Adds a key frame whose id must be keyframe_id_end(). Its `landmarks` must be empty or refer to
  /// landmarks of this map; their observations are added. Ids that are gone are dropped.
  void add_keyframe(KeyFrame keyframe);
  /// Adds a landmark without observations and returns its id.
  LandmarkId add_landmark(Landmark landmark);

  /// Elements to change in place. Their observations, ids, `covisible` and `parent` are changed
  /// through the functions below only.
  KeyFrame& keyframe(KeyFrameId id);
  Landmark& landmark(LandmarkId id);

  /// False, without a change, when the feature already has a landmark or the key frame already
  /// observes this landmark.
  bool add_observation(LandmarkId landmark, Observation observation);
  void remove_observation(LandmarkId landmark, KeyFrameId keyframe);
  /// Removes the landmark and every observation of it.
  void remove_landmark(LandmarkId id);
  /// Gives the observations of `gone` to `kept` and removes `gone`.
  void fuse_landmarks(LandmarkId kept, LandmarkId gone);
  /// Removes a key frame with its observations; its children go to its covisible relatives. The
  /// oldest key frame cannot be removed.
  void remove_keyframe(KeyFrameId id);
  /// Removes all elements. Ids go on from where they are: the next key frame begins a new map.
  void clear();

  /// Counts shared landmarks anew for a key frame, on both sides of every edge. Edges of fewer than
  /// `min_shared` landmarks are left out, but the strongest one is kept. Sets the parent when there
  /// is none yet.
  void update_covisibility(KeyFrameId id, int min_shared = 15);

  /// The finished version; the edit is empty afterwards.
  SparseMap finish() &&;

 private:
  SparseMap map_;
  std::vector<bool> own_keyframe_;  // cloned by this edit
  std::vector<bool> own_landmark_;
};

}  // namespace stillpoint
