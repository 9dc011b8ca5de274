#include "stillpoint/runtime/controlled_run.hpp"

#include <utility>

#include "stillpoint/engine/map_file.hpp"
#include "stillpoint/engine/pace_clock.hpp"
#include "stillpoint/error.hpp"

namespace stillpoint {

LiveRun::Pause ControlledRun::pause() {
  const std::lock_guard lock(mutex_);
  ++pauses_;
  return {this, [self = shared_from_this()](const void*) { self->resume(); }};
}

void ControlledRun::resume() {
  const std::lock_guard lock(mutex_);
  if (--pauses_ == 0) step_ = false;
  changed_.notify_all();
}

void ControlledRun::step() {
  const std::lock_guard lock(mutex_);
  step_ = pauses_ > 0;
  changed_.notify_all();
}

bool ControlledRun::paused() const {
  const std::lock_guard lock(mutex_);
  return pauses_ > 0;
}

void ControlledRun::wait_while_paused(std::stop_token stop) {
  std::unique_lock lock(mutex_);
  if (pauses_ == 0) return;
  SteadyClock clock;
  const double begin = clock.now();
  changed_.wait(lock, std::move(stop), [this] { return pauses_ == 0 || step_; });
  step_ = false;
  paused_seconds_ += clock.now() - begin;
}

double ControlledRun::paused_seconds() const {
  const std::lock_guard lock(mutex_);
  return paused_seconds_;
}

std::optional<std::vector<LabelledPoint>> ControlledRun::dense_map() {
  const std::shared_lock lock(reach_mutex_);
  if (!reach_) return std::nullopt;
  return reach_->dense_map();
}

bool ControlledRun::save_dense_map(const std::filesystem::path& directory) {
  const std::shared_lock lock(reach_mutex_);
  return reach_ && reach_->save_dense_map(directory);
}

void ControlledRun::save_map() {
  if (map_file_.empty())
    throw Error(Fault::kUsage, "the program has named no file for the sparse map");
  const std::shared_lock lock(reach_mutex_);
  const std::lock_guard one_at_a_time(save_mutex_);
  if (!reach_) throw Error(Fault::kUsage, "the run has ended", map_file_.string());
  stillpoint::save_map(*reach_->map(), map_file_);
}

void ControlledRun::end() {
  const std::lock_guard lock(reach_mutex_);
  reach_.reset();
}

}  // namespace stillpoint
