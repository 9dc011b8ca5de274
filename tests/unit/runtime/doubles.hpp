// Stages that do little, on purpose, and write down what happens to them.
#pragma once

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "stillpoint/runtime/stage.hpp"
#include "stillpoint/support/run_statistics.hpp"

namespace stillpoint::testing {

/// What was called, in order; of all threads. Calls can be made to fail.
class CallLog {
 public:
  void write(const std::string& call, std::uint32_t frame) {
    std::string entry = call;
    entry.append(" ").append(std::to_string(frame));
    {
      const std::lock_guard lock(mutex_);
      entries_.push_back(entry);
    }
    changed_.notify_all();
    if (hook) hook(entry);
    if (entry == failing) throw std::runtime_error("out of ideas");
  }
  std::vector<std::string> entries() const {
    const std::lock_guard lock(mutex_);
    return entries_;
  }
  std::vector<std::string> entries(const std::string& beginning) const {
    std::vector<std::string> found;
    for (const std::string& entry : entries())
      if (entry.starts_with(beginning + " ")) found.push_back(entry);
    return found;
  }
  bool contains(const std::string& entry) const {
    const auto all = entries();
    return std::find(all.begin(), all.end(), entry) != all.end();
  }
  void wait_for(const std::string& entry) const {
    std::unique_lock lock(mutex_);
    changed_.wait(
        lock, [&] { return std::find(entries_.begin(), entries_.end(), entry) != entries_.end(); });
  }

  // Both are set before the run.
  std::function<void(const std::string& entry)> hook;
  std::string failing;  ///< entry after which an exception is thrown

 private:
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  std::vector<std::string> entries_;  // guarded by mutex_
};

inline Frame make_frame(std::uint32_t index) {
  static const auto camera = std::make_shared<const Camera>(Camera{.width = 1, .height = 1});
  return {.index = index,
          .time = 10.0 + 0.1 * index,
          .bgr = cv::Mat(1, 1, CV_8UC3, cv::Scalar::all(0)),
          .gray = cv::Mat(1, 1, CV_8UC1, cv::Scalar(0)),
          .depth = cv::Mat(1, 1, CV_32FC1, cv::Scalar(1)),
          .camera = camera};
}

class FakeSource final : public Source {
 public:
  FakeSource(CallLog& calls, std::uint32_t frames) : calls_(calls), frames_(frames) {}
  std::optional<Frame> next() override {
    if (next_ == frames_) return std::nullopt;
    calls_.write("source", next_);
    return make_frame(next_++);
  }
  std::optional<std::size_t> size() const override { return frames_; }
  SourceReport report() const override { return {.skipped = 2, .warnings = {"two were bad"}}; }

 private:
  CallLog& calls_;
  std::uint32_t frames_;
  std::uint32_t next_ = 0;
};

class FakeSegmenter final : public Segmenter {
 public:
  explicit FakeSegmenter(CallLog& calls) : calls_(calls) {}
  ClassNames classes() const override { return named_classes("voc21"); }
  Segmentation segment(const Frame& frame) override {
    calls_.write("segment", frame.index);
    return {.labels = cv::Mat::zeros(1, 1, CV_8UC1), .frame = frame.index};
  }

 private:
  CallLog& calls_;
};

class FakePropagator final : public Propagator {
 public:
  explicit FakePropagator(CallLog& calls) : calls_(calls) {}
  Segmentation propagate(const Segmentation& segmentation, const Frame& from,
                         const Frame& to) override {
    if (segmentation.frame != from.index) throw std::logic_error("labels of another frame");
    calls_.write(std::string("propagate ").append(std::to_string(from.index)), to.index);
    Segmentation moved = segmentation;
    moved.frame = to.index;
    return moved;
  }

 private:
  CallLog& calls_;
};

class FakeChecker final : public MovingChecker {
 public:
  explicit FakeChecker(CallLog& calls) : calls_(calls) {}
  MovingPoints check(const Frame& previous, const Frame& current,
                     const TrackingHistory& known) override {
    calls_.write(std::string("check ").append(std::to_string(previous.index)), current.index);
    history = known;
    return {.reliable = true};
  }
  std::size_t wanted_keyframes() const override { return wanted; }

  std::size_t wanted = 0;   // set before the run
  TrackingHistory history;  // of the last call

 private:
  CallLog& calls_;
};

/// Says how many guesses it was given: as log-odds of a single cell.
class FakeMapChecker final : public MapChecker {
 public:
  explicit FakeMapChecker(CallLog& calls) : calls_(calls) {}
  MapEvidence check(const Frame& frame, std::span<const Pose> guesses, const SparseMap&) override {
    calls_.write("compare", frame.index);
    for (const Pose& guess : guesses) last_guesses.push_back(guess.translation().x());
    return {cv::Mat(1, 1, CV_32FC1, cv::Scalar(static_cast<double>(guesses.size())))};
  }
  void remember(const TrackedFrame& frame) override {
    calls_.write("remember", frame.frame->index);
  }
  void clear() override { calls_.write("forget", 0); }
  std::vector<double> last_guesses;  // metres along x, of all calls

 private:
  CallLog& calls_;
};

class FakeDecision final : public Decision {
 public:
  explicit FakeDecision(CallLog& calls) : calls_(calls) {}
  StaticWeights decide(const Frame& frame, const Segmentation& segmentation, const MovingPoints&,
                       const MapEvidence&) override {
    calls_.write("decide", frame.index);
    return {.object_moves = std::vector<bool>(segmentation.objects.size(), true)};
  }

 private:
  CallLog& calls_;
};

/// Moves one metre along x per frame; every `spacing`-th frame is a key frame.
class FakeTracker final : public Tracker {
 public:
  explicit FakeTracker(CallLog& calls, std::uint32_t spacing = 2)
      : calls_(calls), spacing_(spacing) {}
  PreparedFramePtr prepare(FramePtr frame) override {
    calls_.write("prepare", frame->index);
    return std::make_unique<PreparedFrame>(std::move(frame));
  }
  TrackResult track(PreparedFramePtr prepared, const StaticWeights&, const SparseMap& map,
                    TrackHints hints) override {
    const FramePtr& frame = prepared->frame;
    calls_.write("track", frame->index);
    if (hints.next_keyframe > 0 && map.empty())
      throw std::logic_error("the first key frame is not there");
    TrackResult result{.state = TrackState::kTracking};
    const Pose pose(Eigen::Translation3d(frame->index, 0.0, 0.0));
    if (frame->index % spacing_ == 0) {
      KeyFrame keyframe{.id = hints.next_keyframe, .frame = frame->index, .time = frame->time};
      keyframe.world_from_camera = pose;
      keyframe.camera = frame->camera;
      keyframe.features = std::make_shared<const Features>();
      reference_ = keyframe;
      result.keyframe = std::move(keyframe);
    }
    result.reference = reference_.id;
    result.reference_from_camera = reference_.world_from_camera.inverse() * pose;
    // A loop may have moved the reference.
    result.world_from_camera =
        reference_.id < map.keyframe_id_end()
            ? map.world_from_keyframe(reference_.id) * result.reference_from_camera
            : pose;
    return result;
  }

 private:
  CallLog& calls_;
  std::uint32_t spacing_;
  KeyFrame reference_;
};

class FakeMapper final : public LocalMapper {
 public:
  explicit FakeMapper(CallLog& calls) : calls_(calls), insertion_(make_null_stage<LocalMapper>()) {}
  SparseMap insert(SparseMap map, KeyFrame keyframe) override {
    calls_.write("insert", keyframe.frame);
    return insertion_->insert(std::move(map), std::move(keyframe));
  }
  SparseMap refine(SparseMap map, KeyFrameId id, std::stop_token end_early) override {
    calls_.write("refine", map.keyframe(id)->frame);
    if (while_refining) while_refining(id, end_early);
    return map;
  }

  std::function<void(KeyFrameId, std::stop_token)> while_refining;

 private:
  CallLog& calls_;
  std::shared_ptr<LocalMapper> insertion_;
};

/// Closes a loop at every key frame: everything moves one metre along y.
class FakeCloser final : public LoopCloser {
 public:
  explicit FakeCloser(CallLog& calls) : calls_(calls) {}
  std::optional<MapCorrection> close(const SparseMap& map, KeyFrameId latest,
                                     std::stop_token) override {
    calls_.write("close", map.keyframe(latest)->frame);
    MapCorrection correction{.keyframe_id_end = static_cast<KeyFrameId>(map.keyframe_id_end())};
    for (KeyFrameId id = 0; id < map.keyframe_id_end(); ++id)
      correction.moved.push_back(
          {id, Eigen::Translation3d(0.0, 1.0, 0.0) * map.world_from_keyframe(id)});
    return correction;
  }
  std::optional<MapCorrection> adjust(const SparseMap& map, std::stop_token) override {
    calls_.write("adjust", map.keyframe(map.keyframe_id_begin())->frame);
    return std::nullopt;
  }

 private:
  CallLog& calls_;
};

/// Knows where each key frame is.
class FakeBackend final : public MapBackend {
 public:
  explicit FakeBackend(CallLog& calls) : calls_(calls) {}
  void integrate(const DenseKeyFrame& keyframe) override {
    calls_.write("integrate", keyframe.frame->index);
    if (while_integrating) while_integrating();
    if (!keyframe.segmentation || !keyframe.weights) throw std::logic_error("incomplete");
    poses[keyframe.id] = keyframe.world_from_camera;
  }
  void move(std::span<const MovedKeyFrame> moved) override {
    for (const MovedKeyFrame& m : moved)
      if (poses.contains(m.keyframe)) poses[m.keyframe] = m.world_from_camera;
  }
  void clear() override {
    calls_.write("clear", 0);
    poses.clear();
  }
  void save(const std::filesystem::path& directory) override {
    calls_.write("save", 0);
    if (while_saving) while_saving(directory);
  }
  std::vector<LabelledPoint> occupied() const override {
    if (fails_once.exchange(false)) throw std::logic_error("a broken cell");
    return std::vector<LabelledPoint>(poses.size());
  }

  std::map<KeyFrameId, Pose> poses;
  mutable std::atomic<bool> fails_once = false;  // in occupied()
  std::function<void()> while_integrating;
  std::function<void(const std::filesystem::path&)> while_saving;

 private:
  CallLog& calls_;
};

class FakeOutput final : public Output {
 public:
  explicit FakeOutput(CallLog& calls) : calls_(calls) {}
  bool may_miss_frames() const override { return is_viewer; }
  void frame(const FrameReport& report) override {
    for (const StageTime& time : report.times) times.push_back(time);
    calls_.write("output", report.frame->index);
  }
  void finish(const RunSummary& summary) override {
    for (const StageTime& time : summary.times) times.push_back(time);
    map = summary.map;
    poses = summary.poses;
    statistics = tracking_statistics(summary);
    source = summary.source;
    dropped = summary.dropped_frames;
    dropped_reports = summary.dropped_reports;
    complete = summary.complete;
    failure = summary.failure;
    map_directory = summary.map_directory;
    dense_points = summary.dense_map().size();
    ++finished;
    calls_.write("finish", 0);
  }
  void ended_before_first_frame(const RunSummary& summary) override {
    before_first_frame = true;
    finish(summary);
  }

  bool is_viewer = false;
  bool before_first_frame = false;  // it ended then
  std::vector<StageTime> times;
  SparseMap map;
  std::vector<TrackedPose> poses;
  TrackingStatistics statistics;
  SourceReport source;
  int dropped = -1;
  int dropped_reports = -1;
  bool complete = false;
  std::string failure;
  std::filesystem::path map_directory;
  std::size_t dense_points = 0;
  int finished = 0;

 private:
  CallLog& calls_;
};

}  // namespace stillpoint::testing
