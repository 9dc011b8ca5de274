// Passes each new version of the sparse map from its writer to all readers.
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <stop_token>
#include <utility>

#include "stillpoint/contracts/sparse_map.hpp"

namespace stillpoint {

/// One thread publishes, any thread takes snapshots. A snapshot never changes.
class MapStore {
 public:
  using Snapshot = std::shared_ptr<const SparseMap>;

  explicit MapStore(SparseMap first = {})
      : map_(std::make_shared<const SparseMap>(std::move(first))) {}

  Snapshot snapshot() const {
    const std::lock_guard lock(mutex_);
    return map_;
  }

  void publish(SparseMap map) {
    Snapshot next = std::make_shared<const SparseMap>(std::move(map));
    {
      const std::lock_guard lock(mutex_);
      map_.swap(next);
    }
    changed_.notify_all();
  }  // the last version is freed here, outside the lock, when nobody else holds it

  /// Waits until there is a key frame. False after a stop.
  bool wait_begun(std::stop_token stop) const {
    std::unique_lock lock(mutex_);
    return changed_.wait(lock, std::move(stop), [this] { return !map_->empty(); });
  }

 private:
  mutable std::mutex mutex_;
  mutable std::condition_variable_any changed_;
  Snapshot map_;  // guarded by mutex_
};

}  // namespace stillpoint
