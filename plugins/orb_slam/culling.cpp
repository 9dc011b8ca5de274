#include "orb_slam/culling.hpp"

namespace stillpoint::orb_slam {
namespace {

// Those of ORB-SLAM (VI-B and VI-E), but that a second observation is enough where it asks for a
// third: depth gives a landmark its place from the first one on.
constexpr double kMinFoundRatio = 0.25;
constexpr KeyFrameId kTrialKeyFrames = 2;  // within which the second one must come
constexpr int kMinOtherObservers = 3;

enum class Verdict { kRemove, kKeep, kUndecided };

Verdict classify(const Landmark& landmark, KeyFrameId latest) {
  if (landmark.found < kMinFoundRatio * landmark.visible) return Verdict::kRemove;
  const KeyFrameId age = latest - landmark.created_by;
  if (age >= kTrialKeyFrames && landmark.observations.size() < 2) return Verdict::kRemove;
  return age > kTrialKeyFrames ? Verdict::kKeep : Verdict::kUndecided;
}

// Whether enough other key frames see the landmark at most one pyramid level coarser.
bool observed_elsewhere(const SparseMap& map, const Landmark& landmark, KeyFrameId id, int level) {
  int others = 0;
  for (const Observation& o : landmark.observations) {
    if (o.keyframe == id) continue;
    if (map.keyframe(o.keyframe)->features->keypoints[o.feature].octave <= level + 1) ++others;
    if (others == kMinOtherObservers) return true;
  }
  return false;
}

bool is_redundant(const SparseMap& map, const KeyFrame& keyframe, double share) {
  int landmarks = 0, redundant = 0;
  for (std::uint32_t i = 0; i < keyframe.landmarks.size(); ++i) {
    const Landmark* landmark = map.landmark(keyframe.landmarks[i]);
    if (!landmark) continue;
    ++landmarks;
    redundant +=
        observed_elsewhere(map, *landmark, keyframe.id, keyframe.features->keypoints[i].octave);
  }
  return redundant > share * landmarks;
}

}  // namespace

void cull_landmarks(MapEdit& edit, KeyFrameId latest, std::vector<LandmarkId>& recent) {
  std::erase_if(recent, [&](LandmarkId id) {
    const Landmark* landmark = edit.map().landmark(id);
    if (!landmark) return true;
    const Verdict verdict = classify(*landmark, latest);
    if (verdict == Verdict::kRemove) edit.remove_landmark(id);
    return verdict != Verdict::kUndecided;
  });
}

void cull_keyframes(MapEdit& edit, KeyFrameId latest, double redundant_share) {
  const std::vector<Covisibility> covisible = edit.map().keyframe(latest)->covisible;
  for (const Covisibility& c : covisible) {
    if (c.keyframe == edit.map().keyframe_id_begin()) continue;  // the origin
    if (is_redundant(edit.map(), *edit.map().keyframe(c.keyframe), redundant_share))
      edit.remove_keyframe(c.keyframe);
  }
}

}  // namespace stillpoint::orb_slam
