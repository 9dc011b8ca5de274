// Which threads get the processor when there are too few.
#pragma once

#include <sys/resource.h>
#include <unistd.h>

namespace stillpoint {

enum class ThreadPriority {
  kTracking,
  kMapping,    ///< two thirds of tracking's share while both want to run
  kNetwork,    ///< a third of it
  kBackground  ///< a tenth of it
};

/// Of the calling thread. On Linux, the nice value belongs to a thread, and everybody may raise it.
inline void set_priority(ThreadPriority priority) {
  if (priority == ThreadPriority::kTracking) return;
  constexpr int kNice[] = {0, 2, 5, 10};
  const int nice = kNice[static_cast<int>(priority)];
  const auto self = static_cast<id_t>(gettid());
  setpriority(PRIO_PROCESS, self, getpriority(PRIO_PROCESS, self) + nice);
}

}  // namespace stillpoint
