// What is said where a scene needs more memory than there is.
#pragma once

#include <cstddef>

namespace stillpoint::simulation {

/// Throws Error(kStage) unless so many bytes could be had. They are given back at once.
void require_memory(std::size_t bytes);

/// In a catch clause: throws the same error where what was caught says that memory is exhausted,
/// and otherwise what was caught.
[[noreturn]] void rethrow_named();

}  // namespace stillpoint::simulation
