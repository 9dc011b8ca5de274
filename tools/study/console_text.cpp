#include "study/console_text.hpp"

#include <cstring>
#include <fstream>

namespace stillpoint::study {

std::string failure_text(const std::filesystem::path& console, const ProcessEnd& end) {
  if (end.signal != 0) return std::string("ended by a signal: ") + strsignal(end.signal);
  std::ifstream stream(console);
  std::string errors, last;
  for (std::string line; std::getline(stream, line);) {
    if (line.empty()) continue;
    last = line;
    const std::size_t at = line.find("error: ");
    if (at == std::string::npos) continue;
    // "error: …" of the program, or "file:line:column: error: …" of a configuration.
    errors += (errors.empty() ? "" : "; ") + (at == 0 ? line.substr(7) : line);
  }
  if (!errors.empty()) return errors;
  return last.empty() ? "it wrote nothing to its console" : last;
}

}  // namespace stillpoint::study
