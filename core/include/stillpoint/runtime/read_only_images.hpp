// `runtime.validate: full`: images of frames in memory that nobody can write to.
#pragma once

#include "stillpoint/contracts/frame.hpp"
#include "stillpoint/export.hpp"

namespace stillpoint {

/// The frame with its images copied to pages that are read-only. Whatever writes to them gets
/// SIGSEGV at that very place, on whichever thread; a StageGuard names the stage, a ThreadWatch the
/// plugin of the thread. Throws Error(kStage) without memory.
STILLPOINT_EXPORT Frame with_read_only_images(Frame frame);

/// Whether an address lies in such an image. For signal handlers.
bool in_read_only_image(const void* address);

}  // namespace stillpoint
