// A queue between two threads that cannot grow without bound.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>
#include <stop_token>
#include <utility>

namespace stillpoint {

/// Any number of threads push, one thread pops. Every wait ends when a stop is requested; what is
/// in the queue then stays there.
template <class T>
class BoundedQueue {
 public:
  explicit BoundedQueue(std::size_t capacity) : capacity_(capacity) {}

  /// Waits for room. False when the item was refused because of a stop or close().
  bool push(T item, std::stop_token stop) {
    std::unique_lock lock(mutex_);
    const bool room = changed_.wait(lock, std::move(stop),
                                    [this] { return closed_ || items_.size() < capacity_; });
    if (!room || closed_) return false;
    append(std::move(item));
    return true;
  }

  /// Never waits and never refuses, even when full: for one edge of a cycle of queues, which could
  /// deadlock otherwise.
  void push_past_limit(T item) {
    const std::lock_guard lock(mutex_);
    append(std::move(item));
  }

  /// Never waits: without room the item that has waited longest is dropped. Whether one was.
  bool push_or_drop_oldest(T item) {
    const std::lock_guard lock(mutex_);
    if (closed_) return false;
    const bool full = items_.size() >= capacity_;
    if (full) items_.pop_front();
    append(std::move(item));
    return full;
  }

  /// The next item, or nothing after a stop or when the closed queue is empty. Whoever takes an
  /// item counts as busy until the next call.
  std::optional<T> pop(std::stop_token stop) {
    std::unique_lock lock(mutex_);
    busy_ = false;
    changed_.notify_all();
    const bool ready = changed_.wait(lock, stop, [this] { return closed_ || !items_.empty(); });
    if (!ready || stop.stop_requested() || items_.empty()) return std::nullopt;
    T item = std::move(items_.front());
    items_.pop_front();
    busy_ = true;
    changed_.notify_all();
    return item;
  }

  /// Waits until nothing is queued and the taker is not busy. False after a stop.
  bool wait_idle(std::stop_token stop) {
    std::unique_lock lock(mutex_);
    return changed_.wait(lock, std::move(stop), [this] { return items_.empty() && !busy_; });
  }

  /// No more pushes; what waits can still be taken.
  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }

  std::size_t size() const {
    const std::lock_guard lock(mutex_);
    return items_.size();
  }

 private:
  void append(T item) {
    items_.push_back(std::move(item));
    changed_.notify_all();
  }

  const std::size_t capacity_;
  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<T> items_;  // guarded by mutex_, like all below
  bool closed_ = false;
  bool busy_ = false;
};

}  // namespace stillpoint
