// Symbols shared between the program and its plugins; everything else is hidden.
#pragma once

#define STILLPOINT_EXPORT __attribute__((visibility("default")))
