// A loop over independent items on a few threads.
#pragma once

#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace stillpoint::simulation {

/// Calls body(i) for 0 <= i < count; the caller's thread works as well, alone where the system has
/// no thread to give. Rethrows the first fault.
template <class Body>
void parallel_for(int threads, int count, Body&& body) {
  std::atomic<int> next = 0;
  std::exception_ptr fault;
  std::mutex fault_mutex;
  const auto work = [&] {
    try {
      for (int i = next++; i < count; i = next++) body(i);
    } catch (...) {
      next = count;
      const std::scoped_lock lock(fault_mutex);
      if (!fault) fault = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> helpers;
    try {
      for (int i = 1; i < threads && i < count; ++i) helpers.emplace_back(work);
    } catch (const std::system_error&) {  // those there are do the work
    }
    work();
  }
  if (fault) std::rethrow_exception(fault);
}

}  // namespace stillpoint::simulation
