// DDS for tests: on the loopback interface, in a domain of the process's own.
#pragma once

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace stillpoint::testing {

/// A domain that no other test of this machine has; this process keeps it until its end.
inline int free_domain() {
  constexpr int kDomains = 100;
  for (int i = 0; i < kDomains; ++i) {
    const int domain = 1 + (::getpid() + i) % kDomains;
    const auto file = std::filesystem::temp_directory_path() /
                      ("stillpoint_test_domain_" + std::to_string(domain));
    const int lock = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (lock >= 0 && ::flock(lock, LOCK_EX | LOCK_NB) == 0) return domain;
    if (lock >= 0) ::close(lock);
  }
  throw std::runtime_error("no domain of DDS is free");
}

/// The number of the domain.
inline int loopback_domain() {
  ::setenv("ROS_LOCALHOST_ONLY", "1", 1);
  static const int domain = free_domain();
  return domain;
}

}  // namespace stillpoint::testing
