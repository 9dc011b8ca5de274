// For the engine, which guards calls of plugins.
#pragma once

#include "stillpoint/export.hpp"

namespace stillpoint {

/// `around` is called when the first image needs the codecs, by the thread that needs them, and has
/// to call `load`, which throws when they cannot be loaded.
STILLPOINT_EXPORT void load_image_codec_with(void (*around)(void (*load)()));

}  // namespace stillpoint
