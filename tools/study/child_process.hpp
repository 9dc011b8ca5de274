// Another program, run to its end.
#pragma once

#include <filesystem>
#include <stop_token>
#include <string>
#include <vector>

namespace stillpoint::study {

struct ProcessEnd {
  int exit_code = 0;  ///< 128 + signal when one ended it, as shells say it
  int signal = 0;
  bool in_time = true;
};

/// Starts `command` (an absolute path and its arguments), its output going to `console`, and waits.
/// A stop sends it SIGINT, once, and waits on; so does the end of its time (seconds; 0: no limit),
/// and ten seconds later it is killed. In a process group of its own, so that Ctrl-C reaches it
/// only that way; it is killed when the calling thread ends before it. Throws Error(kStage) when it
/// cannot be started.
ProcessEnd run_process(std::vector<std::string> command, const std::filesystem::path& console,
                       const std::stop_token& stop, double time_limit = 0.0);

/// This program's own file.
std::filesystem::path this_program();

}  // namespace stillpoint::study
