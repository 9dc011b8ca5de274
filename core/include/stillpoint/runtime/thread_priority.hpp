// Which threads get the processor when there are too few.
#pragma once

#include <sys/resource.h>
#include <unistd.h>

namespace stillpoint {

enum class ThreadPriority {
  kNormal,
  kBackground  ///< a tenth of a normal thread's share while both want to run
};

/// Of the calling thread. On Linux, the nice value belongs to a thread, and everybody may raise it.
inline void set_priority(ThreadPriority priority) {
  constexpr int kNice = 10;
  if (priority == ThreadPriority::kNormal) return;
  const auto self = static_cast<id_t>(gettid());
  setpriority(PRIO_PROCESS, self, getpriority(PRIO_PROCESS, self) + kNice);
}

}  // namespace stillpoint
