#include "stillpoint/runtime/null_stages.hpp"

#include <span>
#include <utility>

namespace stillpoint {
namespace {

class NullSegmenter final : public Segmenter {
 public:
  ClassNames classes() const override { return {}; }
  Segmentation segment(const Frame& frame) override { return {.frame = frame.index}; }
};

// Labels stay where they were: those of the frame itself when the network is waited for.
class NullPropagator final : public Propagator {
 public:
  Segmentation propagate(const Segmentation& segmentation, const Frame&, const Frame& to) override {
    Segmentation unmoved = segmentation;
    unmoved.frame = to.index;
    return unmoved;
  }
};

class NullMovingChecker final : public MovingChecker {
 public:
  MovingPoints check(const Frame&, const Frame&, const TrackingHistory&) override { return {}; }
};

class NullMapChecker final : public MapChecker {
 public:
  MapEvidence check(const Frame&, std::span<const Pose>, const SparseMap&) override { return {}; }
  void remember(const TrackedFrame&) override {}
  void clear() override {}
};

class NullDecision final : public Decision {
 public:
  StaticWeights decide(const Frame&, const Segmentation&, const MovingPoints&,
                       const MapEvidence&) override {
    return {};
  }
};

class NullTracker final : public Tracker {
 public:
  PreparedFramePtr prepare(FramePtr frame) override {
    return std::make_unique<PreparedFrame>(std::move(frame));
  }
  TrackResult track(PreparedFramePtr, const StaticWeights&, const SparseMap&, TrackHints) override {
    return {};
  }
};

class NullLocalMapper final : public LocalMapper {
 public:
  SparseMap insert(SparseMap map, KeyFrame keyframe) override {
    const KeyFrameId id = keyframe.id;
    MapEdit edit(std::move(map));
    edit.add_keyframe(std::move(keyframe));
    edit.update_covisibility(id);
    return std::move(edit).finish();
  }
  SparseMap refine(SparseMap map, KeyFrameId, std::stop_token) override { return map; }
};

class NullLoopCloser final : public LoopCloser {
 public:
  std::optional<MapCorrection> close(const SparseMap&, KeyFrameId, std::stop_token) override {
    return std::nullopt;
  }
};

class NullMapBackend final : public MapBackend {
 public:
  void integrate(const DenseKeyFrame&) override {}
  void move(std::span<const MovedKeyFrame>) override {}
  void clear() override {}
  void save(const std::filesystem::path&) override {}
};

}  // namespace

template <>
std::shared_ptr<Segmenter> make_null_stage() {
  return std::make_shared<NullSegmenter>();
}
template <>
std::shared_ptr<Propagator> make_null_stage() {
  return std::make_shared<NullPropagator>();
}
template <>
std::shared_ptr<MovingChecker> make_null_stage() {
  return std::make_shared<NullMovingChecker>();
}
template <>
std::shared_ptr<MapChecker> make_null_stage() {
  return std::make_shared<NullMapChecker>();
}
template <>
std::shared_ptr<Decision> make_null_stage() {
  return std::make_shared<NullDecision>();
}
template <>
std::shared_ptr<Tracker> make_null_stage() {
  return std::make_shared<NullTracker>();
}
template <>
std::shared_ptr<LocalMapper> make_null_stage() {
  return std::make_shared<NullLocalMapper>();
}
template <>
std::shared_ptr<LoopCloser> make_null_stage() {
  return std::make_shared<NullLoopCloser>();
}
template <>
std::shared_ptr<MapBackend> make_null_stage() {
  return std::make_shared<NullMapBackend>();
}

}  // namespace stillpoint
