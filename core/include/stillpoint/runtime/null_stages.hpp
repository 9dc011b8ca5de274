// What sits in a box that a pipeline file leaves out.
#pragma once

#include <memory>
#include <string>

#include "stillpoint/sdk.hpp"

namespace stillpoint {

/// No labels; no propagation; no moving points; no map evidence; full weights; no tracking; a map
/// of the key frames with the landmarks that they come with; no loops; no dense map.
template <class Interface>
std::shared_ptr<Interface> make_null_stage() {
  throw Error(Fault::kUsage, std::string("a pipeline needs a ") + Interface::kKind);
}

template <>
std::shared_ptr<Segmenter> make_null_stage();
template <>
std::shared_ptr<Propagator> make_null_stage();
template <>
std::shared_ptr<MovingChecker> make_null_stage();
template <>
std::shared_ptr<MapChecker> make_null_stage();
template <>
std::shared_ptr<Decision> make_null_stage();
template <>
std::shared_ptr<Tracker> make_null_stage();
template <>
STILLPOINT_EXPORT std::shared_ptr<LocalMapper> make_null_stage();
template <>
std::shared_ptr<LoopCloser> make_null_stage();
template <>
std::shared_ptr<MapBackend> make_null_stage();

}  // namespace stillpoint
