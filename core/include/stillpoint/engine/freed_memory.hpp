// Allocator settings for a program that handles images at 30 Hz.
#pragma once

#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace stillpoint {

/// Keeps freed memory in the process. Otherwise the memory of every image returns to the system,
/// and new pages are cleared: 8 % of the processor time of a run, two thirds of that of
/// `paste_people`. Call it first in main(): threads keep the settings from before they started.
inline void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int kLargestBlock = 32 << 20;  // bytes; the most that glibc accepts
  constexpr int kTrimThreshold = 1 << 30;  // bytes
  mallopt(M_MMAP_THRESHOLD, kLargestBlock);
  mallopt(M_TRIM_THRESHOLD, kTrimThreshold);
#endif
}

}  // namespace stillpoint
