// What a program that handles images at 30 Hz tells the allocator.
#pragma once

#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace stillpoint {

/// Keeps freed memory in the process. Otherwise every image is given back to the system and taken
/// again, cleared page by page: 8 % of the processor time of a run, two thirds of `paste_people`'s.
/// Call it first thing in main(): threads allocate as was said before they began.
inline void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int kLargestBlock = 32 << 20;  // bytes; the most that glibc accepts
  constexpr int kLargestRest = 1 << 30;    // bytes
  mallopt(M_MMAP_THRESHOLD, kLargestBlock);
  mallopt(M_TRIM_THRESHOLD, kLargestRest);
#endif
}

}  // namespace stillpoint
