#include "output_web/recorder.hpp"

#include <cerrno>
#include <cstring>
#include <stillpoint/support/base64.hpp>
#include <string>
#include <utility>

namespace stillpoint::output_web {
namespace {

constexpr std::size_t kImageStep = 3;  // frames

}  // namespace

Recorder::Recorder(std::filesystem::path file, std::string_view page)
    : file_(std::move(file)), stream_(file_, std::ios::binary) {
  if (!(stream_ << page << '\n' << std::flush))
    throw Error(Fault::kUsage, file_.string() + " cannot be written: " + std::strerror(errno),
                "record", "give another name");
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
  stream_ << "<script type=\"text/plain\" class=\"message\">" << base64(message) << "</script>\n"
          << std::flush;
  if (!stream_)
    throw Error(Fault::kUsage, "no room for the recording of the live view", file_.string());
}

}  // namespace stillpoint::output_web
