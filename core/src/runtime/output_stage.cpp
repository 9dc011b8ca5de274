#include "stillpoint/runtime/output_stage.hpp"

#include <exception>
#include <utility>

namespace stillpoint {
namespace {

constexpr std::size_t kReportsWaiting = 8;  // with the images of their frames, 2.5 MB each

}  // namespace

OutputStage::OutputStage(std::vector<Stage<Output>> outputs, WhenFull when_full, Mode mode,
                         StopSignal& stop, TimeLog& times)
    : drops_(when_full == WhenFull::kDrop),
      label_(drops_ ? "output " + outputs.front().type : "outputs"),
      stop_(stop),
      times_(times),
      queue_(kReportsWaiting) {
  for (Stage<Output>& output : outputs) outputs_.emplace_back(std::move(output), "output", times);
  if (mode == Mode::kThreaded && !outputs_.empty()) thread_ = std::jthread([this] { work(); });
}

void OutputStage::begin(const std::shared_ptr<LiveRun>& run) {
  for (StageCaller<Output>& output : outputs_) output.call_unmeasured({}, &Output::begin, run);
}

void OutputStage::frame(FrameReportPtr report) {
  if (!thread_.joinable())
    write(*report);
  else if (drops_)
    dropped_ += queue_.push_or_drop_oldest(std::move(report)) ? 1 : 0;
  else
    queue_.push(std::move(report), stop_.token());
}

void OutputStage::end() {
  queue_.close();
  if (thread_.joinable()) thread_.join();
}

void OutputStage::finish(void (Output::*last)(const RunSummary&),
                         const std::function<RunSummary()>& summary) {
  for (StageCaller<Output>& output : outputs_) {
    if (!output.usable()) continue;
    try {
      output.call_unmeasured({}, last, summary());
    } catch (...) {
      stop_.fail(std::current_exception());
    }
  }
}

void OutputStage::write(const FrameReport& report) {
  const std::uint32_t index = report.frame->index;
  const ScopedTime time(times_, label_.c_str(), index);
  for (StageCaller<Output>& output : outputs_)
    output.call_unmeasured(index, &Output::frame, report);
}

void OutputStage::work() {
  try {
    while (const auto report = queue_.pop({})) write(**report);
  } catch (...) {
    stop_.fail(std::current_exception());
    queue_.close();
  }
}

}  // namespace stillpoint
