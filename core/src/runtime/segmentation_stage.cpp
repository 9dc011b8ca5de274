#include "stillpoint/runtime/segmentation_stage.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "stillpoint/engine/stage_guard.hpp"
#include "stillpoint/runtime/perception_results.hpp"
#include "stillpoint/support/objects.hpp"

namespace stillpoint {
namespace {

// The times of frames are irregular: so much earlier is in time.
double with_tolerance(double seconds) { return seconds - std::min(0.01, seconds / 4); }

constexpr int kMinObjectPixels = 1;  // segmenters that name no objects have all of them named

/// The share of the image that one class has, at most.
double largest_share(const Segmentation& segmentation) {
  std::array<int, 256> pixels{};
  for (const SegmentedObject& object : segmentation.objects)
    pixels[static_cast<std::size_t>(object.label)] += object.pixels;
  return std::ranges::max(pixels) / static_cast<double>(segmentation.labels.total());
}

Segmentation segment(Segmenter& segmenter, const Frame& frame, std::size_t classes) {
  Segmentation found = segmenter.segment(frame);
  check_segmentation(found, frame, classes);
  return found;
}

Segmentation propagate(Propagator& propagator, const Segmentation& labels, const Frame& from,
                       const Frame& to, std::size_t classes) {
  Segmentation moved = propagator.propagate(labels, from, to);
  check_segmentation(moved, to, classes);
  return moved;
}

}  // namespace

SegmentationStage::SegmentationStage(Stage<Segmenter> segmenter, Stage<Propagator> propagator,
                                     const SegmentationOptions& options, Mode mode,
                                     StopSignal& stop, TimeLog& times)
    : options_(options),
      stop_(stop),
      times_(times),
      segmenter_(std::move(segmenter), "segmentation", times),
      propagator_(std::move(propagator), "propagation", times),
      classes_(segmenter_.call_unmeasured({}, &Segmenter::classes)),
      network_(
          segmenter_.present() ? mode : Mode::kInline, 1, stop,
          [this](FramePtr frame) { segment(take(std::move(frame))); },
          options.schedule == Schedule::kLatest ? ThreadPriority::kNetwork
                                                : ThreadPriority::kTracking) {}

void SegmentationStage::offer(const FramePtr& frame) {
  if (options_.schedule == Schedule::kWait)
    network_.push(frame);
  else if (frame->time < next_)
    return;
  else if (network_.threaded())
    network_.push_or_drop_oldest(frame);
  else
    waiting_ = frame;
}

SegmentationPtr SegmentationStage::labels_for(const FramePtr& frame) {
  if (options_.schedule == Schedule::kLatest && !network_.threaded()) imitate_latency(frame);
  const Labelled newest = wait_for(frame);
  if (!newest.frame) return nullptr;
  auto labels = std::make_shared<const Segmentation>(
      propagator_.call("propagate", frame->index, propagate, *newest.labels, *newest.frame, *frame,
                       classes_.size()));
  unlabelled_ += segmenter_.present() && !labels->known() ? 1 : 0;
  return labels;
}

FramePtr SegmentationStage::take(FramePtr frame) {
  if (frame) next_ = frame->time + with_tolerance(options_.interval_seconds);
  return frame;
}

void SegmentationStage::segment(FramePtr frame) {
  auto labels = std::make_shared<const Segmentation>(labels_of(*frame));
  {
    const std::lock_guard lock(mutex_);
    newest_ = {std::move(frame), std::move(labels)};
  }
  changed_.notify_all();
}

Segmentation SegmentationStage::labels_of(const Frame& frame) {
  try {
    Segmentation labels =
        segmenter_.call("segmentation", frame.index, stillpoint::segment, frame, classes_.size());
    if (!labels.known()) return labels;
    if (labels.instances.empty()) find_objects(labels, kMinObjectPixels);
    // Too little would be left to track, and such labels are hardly ever right.
    if (largest_share(labels) > options_.max_labelled) return {.frame = frame.index};
    return labels;
  } catch (const StageError& error) {
    if (options_.on_failure == SegmentationOptions::OnFailure::kStop ||
        StageGuard::has_ended_a_call())
      throw;
    if (failures_++ == 0) first_failure_ = error.what();
    return {.frame = frame.index};
  }
}

void SegmentationStage::imitate_latency(const FramePtr& now) {
  if (!newest_.frame) return segment(take(std::exchange(waiting_, nullptr)));
  if (!running_) running_ = take(std::exchange(waiting_, nullptr));
  if (!running_ || now->time - running_->time < with_tolerance(options_.latency_seconds)) return;
  segment(std::exchange(running_, take(std::exchange(waiting_, nullptr))));
}

SegmentationStage::Labelled SegmentationStage::wait_for(const FramePtr& frame) {
  std::optional<ScopedTime> time;
  if (network_.threaded()) time.emplace(times_, "segmentation_wait", frame->index);
  const auto ready = [&] {
    return options_.schedule == Schedule::kWait ? newest_.frame == frame : newest_.frame != nullptr;
  };
  std::unique_lock lock(mutex_);
  return changed_.wait(lock, stop_.token(), ready) ? newest_ : Labelled{};
}

}  // namespace stillpoint
