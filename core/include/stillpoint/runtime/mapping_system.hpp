// Threads 3 to 5: local mapping, loop closing and the dense map around one sparse map.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <variant>
#include <vector>

#include "stillpoint/runtime/early_end.hpp"
#include "stillpoint/runtime/map_store.hpp"
#include "stillpoint/runtime/stage.hpp"
#include "stillpoint/runtime/worker.hpp"

namespace stillpoint {

/// A key frame on its way into the maps.
struct NewKeyFrame {
  KeyFrame keyframe;
  DenseKeyFrame images;  ///< its pose is filled in by local mapping
};

/// Local mapping is the only writer of the sparse map: the corrections of loop closing come back to
/// it as items of its queue.
class MappingSystem {
 public:
  MappingSystem(Stage<LocalMapper> local_mapper, Stage<LoopCloser> loop_closer,
                Stage<MapBackend> map_backend, SparseMap known_map, const RuntimeOptions& options,
                StopSignal& stop, TimeLog& times);
  ~MappingSystem() { end(); }

  MapStore::Snapshot snapshot() const { return map_.snapshot(); }
  /// The id that the next key frame pushed has to have.
  KeyFrameId next_keyframe() const { return next_keyframe_; }
  /// Waits while too many key frames are waiting, and until the first one of a map is in it:
  /// nothing can be tracked before.
  void push(NewKeyFrame keyframe);
  /// Clears both maps, after the key frames that wait: the next one begins new ones. False, and
  /// nothing cleared, after a stop.
  bool clear();
  /// Whether a key frame has to wait for local mapping.
  bool waiting() const { return local_mapping_.waiting(); }
  /// Finishes what is under way and ends the threads; after a stop, at once.
  void end();
  /// Loops closed. From any thread.
  int loops() const { return loops_; }
  /// What the dense map holds now. From any thread.
  std::vector<LabelledPoint> dense_points();
  /// The same, but nothing while a key frame is being mapped, or without a dense map. What it
  /// throws ends the run as well.
  std::optional<std::vector<LabelledPoint>> dense_points_if_idle();
  /// Writes the dense map as it is now into `directory`; false: there is none. From any thread.
  bool save(const std::filesystem::path& directory);
  /// The same; false as well while a key frame is being mapped, and before the first.
  bool save_if_idle(const std::filesystem::path& directory);

 private:
  // In all of these, `frame` is the key frame's that asked first, for messages and times.
  struct Correction {
    MapCorrection correction;
    std::uint32_t frame = 0;
    bool closes_loop = false;
  };
  struct Clear {};
  using MappingItem = std::variant<NewKeyFrame, Correction, Clear>;
  using DenseItem =
      std::variant<std::shared_ptr<const DenseKeyFrame>, std::vector<MovedKeyFrame>, Clear>;
  // With the map as it was when the key frame had come: later, the key frame may have been removed.
  struct LoopQuery {
    MapStore::Snapshot map;
    KeyFrameId keyframe = kNoId;
    std::uint32_t frame = 0;
  };
  struct AdjustRequest {
    std::uint32_t frame = 0;
  };
  using LoopItem = std::variant<std::shared_ptr<const LoopQuery>, AdjustRequest>;

  void save_locked(const std::filesystem::path& directory);
  void map(NewKeyFrame item);
  void correct(const Correction& item);
  void clear_maps();
  void close_loop(const LoopQuery& query);
  void adjust(const AdjustRequest& request);
  void map_densely(const DenseItem& item);
  void send_moved(const SparseMap& before, const SparseMap& after);

  const bool threaded_;
  const bool thorough_;
  StopSignal& stop_;
  StageCaller<LocalMapper> local_mapper_;
  StageCaller<LoopCloser> loop_closer_;
  StageCaller<MapBackend> map_backend_;
  MapStore map_;
  KeyFrameId next_keyframe_;       // of the thread that pushes
  std::mutex dense_mutex_;         // held while the dense map is called: anybody may read it
  std::uint32_t dense_frame_ = 0;  // given last to the dense map, for messages and times
  bool has_integrated_ = false;    // a key frame; guarded by dense_mutex_
  std::atomic<int> loops_ = 0;
  // Used by the loop thread: a correction was sent that the maps of waiting queries do not have.
  bool correction_pending_ = false;

  EarlyEnd mapping_end_;     // of the local adjustment under way
  EarlyEnd adjustment_end_;  // of that of the whole map

  // Last: their threads use all the others.
  Worker<MappingItem> local_mapping_;
  Worker<LoopItem> loop_closing_;
  Worker<DenseItem> dense_mapping_;
  std::stop_callback<std::function<void()>> ends_on_stop_;
};

}  // namespace stillpoint
