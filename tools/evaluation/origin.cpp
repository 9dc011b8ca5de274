#include "evaluation/origin.hpp"

#include <chrono>
#include <cstdio>
#include <fstream>
#include <thread>

namespace stillpoint::evaluation {
namespace {

/// As Linux names it; empty elsewhere.
std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name"))
      if (const std::size_t colon = line.find(": "); colon != std::string::npos)
        return line.substr(colon + 2);
  return {};
}

std::string machine() {
  const unsigned cores = std::thread::hardware_concurrency();
  const std::string name = processor();
  return (name.empty() ? "" : name + ", ") + std::to_string(cores) +
         (cores == 1 ? " core" : " cores");
}

std::string today() {
  const std::chrono::year_month_day day(
      std::chrono::floor<std::chrono::days>(std::chrono::system_clock::now()));
  char text[16];
  std::snprintf(text, sizeof(text), "%04d-%02u-%02u", static_cast<int>(day.year()),
                static_cast<unsigned>(day.month()), static_cast<unsigned>(day.day()));
  return text;
}

}  // namespace

std::string build_text(const Origin& origin) {
  if (origin.version.empty()) return "a build that has left no record";
  std::string text = "Stillpoint " + origin.version;
  if (!origin.commit.empty()) text += ", commit " + origin.commit;
  return text + "; " + origin.machine;
}

std::string origin_text(const Origin& origin) {
  return build_text(origin) + (origin.date.empty() ? "" : "; " + origin.date);
}

Origin origin_of(const Program& program) {
  return {
      .version = program.version, .commit = program.commit, .machine = machine(), .date = today()};
}

}  // namespace stillpoint::evaluation
