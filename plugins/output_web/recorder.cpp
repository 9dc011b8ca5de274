#include "output_web/recorder.hpp"

#include <cerrno>
#include <cstring>
#include <stillpoint/support/base64.hpp>
#include <string>
#include <utility>

namespace stillpoint::output_web {
namespace {

constexpr std::size_t kImageStep = 3;  // frames

namespace fs = std::filesystem;

/// Leaves what is there as it is.
void require_writable(const fs::path& file) {
  std::error_code none;
  const bool was_there = fs::exists(fs::symlink_status(file, none));
  if (was_there && !fs::is_regular_file(file, none))  // a pipe would be waited for
    throw Error(Fault::kUsage, file.string() + " is no file", "record", "give another name");
  if (!std::ofstream(file, std::ios::binary | std::ios::app))
    throw Error(Fault::kUsage, file.string() + " cannot be written: " + std::strerror(errno),
                "record", "give another name");
  if (!was_there) fs::remove(file, none);
}

}  // namespace

Recorder::Recorder(fs::path file, std::string_view page)
    : file_(std::move(file)), unwritten_(std::string(page) + '\n') {
  require_writable(file_);
}

void Recorder::take(EventLog& events) {
  const bool image = seen_.frames >= next_image_;
  write(events.news(seen_, {.image = image, .map = true, .cloud = true, .voxels = true}));
  if (image && seen_.image) next_image_ = seen_.frames + kImageStep - 1;
}

void Recorder::finish(EventLog& events) {
  const Request all{.image = true, .map = true, .cloud = true, .voxels = true};
  for (std::string rest; !(rest = events.news(seen_, all)).empty();) write(rest);
}

void Recorder::write(std::string_view message) {
  if (message.empty()) return;
  unwritten_ += "<script type=\"text/plain\" class=\"message\">" + base64(message) + "</script>\n";
  if (seen_.frames == 0) return;
  if (!stream_.is_open()) stream_.open(file_, std::ios::binary);
  stream_ << unwritten_ << std::flush;
  unwritten_.clear();
  if (!stream_)
    throw Error(
        Fault::kUsage,
        std::string("the recording of the live view cannot be written: ") + std::strerror(errno),
        file_.string());
}

}  // namespace stillpoint::output_web
