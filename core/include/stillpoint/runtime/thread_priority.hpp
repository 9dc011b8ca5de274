// Which threads get the processor when there are too few.
#pragma once

#include <sys/resource.h>
#include <unistd.h>

namespace stillpoint {

enum class ThreadPriority {
  kNormal,
  kReduced,    ///< a third of a normal thread's share while both want to run
  kBackground  ///< a tenth of it
};

/// Of the calling thread. On Linux, the nice value belongs to a thread, and everybody may raise it.
inline void set_priority(ThreadPriority priority) {
  if (priority == ThreadPriority::kNormal) return;
  const int nice = priority == ThreadPriority::kReduced ? 5 : 10;
  const auto self = static_cast<id_t>(gettid());
  setpriority(PRIO_PROCESS, self, getpriority(PRIO_PROCESS, self) + nice);
}

}  // namespace stillpoint
