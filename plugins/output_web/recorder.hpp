// A run as a page that shows it again.
#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <stillpoint/sdk.hpp>
#include <string>
#include <string_view>

#include "output_web/event_log.hpp"

namespace stillpoint::output_web {

/// A viewer that is always ready, and writes what it gets: the page, then each message in base64
/// within an element of its own. Whenever the process ends, what has been written shows. Until the
/// first frame, the recording of an earlier run stays.
class Recorder {
 public:
  /// Throws Error(kUsage) when the file cannot be written.
  Recorder(std::filesystem::path file, std::string_view page);

  /// What is new, with every third image. On the server's thread. Throws Error when there is no
  /// room for it.
  void take(EventLog& events);
  /// The rest, once the log is finished.
  void finish(EventLog& events);

 private:
  void write(std::string_view message);

  const std::filesystem::path file_;
  std::string unwritten_;
  std::ofstream stream_;  // open from the first frame on
  Seen seen_;
  std::size_t next_image_ = 0;  // with so many frames
};

}  // namespace stillpoint::output_web
