#include "ros2/dense_files.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>

#include "ros2_messages/cost_map_file.hpp"
#include "ros2_messages/octree_file.hpp"
#include "stillpoint/support/temporary_folder.hpp"

namespace stillpoint::ros2 {
namespace {

namespace fs = std::filesystem;

constexpr int kNice = 10;                  // a tenth of tracking's share of the processor
constexpr double kMinIntervalFactor = 20;  // of the time that saving and reading took

// Tracking comes first. On Linux, the nice value belongs to a thread.
void lower_priority() {
  const auto self = static_cast<id_t>(::gettid());
  ::setpriority(PRIO_PROCESS, self, ::getpriority(PRIO_PROCESS, self) + kNice);
}

}  // namespace

DenseFiles read_dense_files(const fs::path& folder, DenseFilesWanted wanted, double time) {
  DenseFiles files{.time = time, .octree = {}, .grid = {}};
  if (wanted.octree) files.octree = ros2_messages::read_octree_message(folder);
  if (wanted.grid) files.grid = ros2_messages::read_cost_map(folder);
  return files;
}

DenseFilesReader::Read DenseFilesReader::save_and_read(LiveRun& run, DenseFilesWanted wanted,
                                                       double time) {
  lower_priority();
  const auto begin = std::chrono::steady_clock::now();
  const TemporaryFolder folder;
  Read read;
  if (run.save_dense_map(folder.path())) read.files = read_dense_files(folder.path(), wanted, time);
  read.took = std::chrono::steady_clock::now() - begin;
  return read;
}

std::optional<DenseFiles> DenseFilesReader::next(double time, DenseFilesWanted wanted) {
  if (!read_.valid()) {
    if (time >= next_ && (wanted.octree || wanted.grid)) {
      next_ = time + period_;
      read_ = std::async(std::launch::async,
                         [run = run_, wanted, time] { return save_and_read(*run, wanted, time); });
    }
    return std::nullopt;
  }
  if (read_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return std::nullopt;
  Read read = read_.get();
  if (read.files) {
    retry_period_ = kFirstRetry;
    next_ = std::max(next_, time + kMinIntervalFactor * read.took.count());
  } else {
    next_ = std::min(next_, time + retry_period_);
    retry_period_ *= 2;  // there may be no dense map at all
  }
  return std::move(read.files);
}

}  // namespace stillpoint::ros2
