// DDS for tests: on the loopback interface, in a domain of the process's own.
#pragma once

#include <unistd.h>

#include <cstdlib>

namespace stillpoint::testing {

/// The number of the domain.
inline int loopback_domain() {
  ::setenv("ROS_LOCALHOST_ONLY", "1", 1);
  return 1 + ::getpid() % 100;
}

}  // namespace stillpoint::testing
