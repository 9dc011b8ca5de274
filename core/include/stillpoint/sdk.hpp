// What is promised to plugins: contracts, options, the descriptor. Helpers without a promise are in
// stillpoint/support, each to be included by its name.
#pragma once

#include "stillpoint/class_names.hpp"
#include "stillpoint/contracts/decision.hpp"
#include "stillpoint/contracts/local_mapper.hpp"
#include "stillpoint/contracts/loop_closer.hpp"
#include "stillpoint/contracts/map_backend.hpp"
#include "stillpoint/contracts/map_checker.hpp"
#include "stillpoint/contracts/moving_checker.hpp"
#include "stillpoint/contracts/output.hpp"
#include "stillpoint/contracts/propagator.hpp"
#include "stillpoint/contracts/segmenter.hpp"
#include "stillpoint/contracts/source.hpp"
#include "stillpoint/contracts/tracker.hpp"
#include "stillpoint/error.hpp"
#include "stillpoint/options.hpp"
#include "stillpoint/plugin.hpp"
#include "stillpoint/pose_math.hpp"
