#include "stillpoint/runtime/abnormal_end.hpp"

#include <unistd.h>

#include <array>
#include <atomic>
#include <cstring>

namespace stillpoint {
namespace {

constexpr unsigned kSecondsToSave = 30;

std::atomic<bool> saving{false};
std::array<char, 1280> final_message{};  // of the handler of SIGALRM

/// Cuts off what finds no room.
void append_to_message(const char* words) {
  const std::size_t used = std::strlen(final_message.data());
  std::strncpy(final_message.data() + used, words, final_message.size() - used - 1);
}

extern "C" void on_saving_hangs(int) {
  write_to_stderr(final_message.data());
  ::_exit(1);
}

}  // namespace

std::string reason_of(int what) {
  if (what == kExited) return "it called std::exit()";
  if (what == kWroteToImage)
    return "it wrote to an image of a frame, which all stages share; work on a copy of it";
  if (what == kGivenUp) return "it did not return and was given up";
  return std::string("it crashed: SIG") + sigabbrev_np(what) + ", " + sigdescr_np(what);
}

void start_time_to_save(std::span<const char* const> words) {
  ::alarm(kSecondsToSave);
  if (saving.exchange(true)) return;
  append_to_message("error: ");
  for (const char* part : words) append_to_message(part);
  append_to_message("; what followed did not return, results may be missing\n");
}

bool has_started_to_save() { return saving; }

void watch_time_to_save() {
  final_message.fill('\0');
  saving = false;
  struct sigaction action {};
  action.sa_handler = on_saving_hangs;
  action.sa_flags = SA_ONSTACK;
  sigaction(SIGALRM, &action, nullptr);
}

void end_time_to_save() {
  ::alarm(0);
  ::signal(SIGALRM, SIG_DFL);
}

void write_to_stderr(const char* words) {
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, words, std::strlen(words));
}

}  // namespace stillpoint
