// Must not compile: a constructor from what the program does not have.
#include "stillpoint/sdk.hpp"

struct Checker final : stillpoint::MovingChecker {
  explicit Checker(int /*points*/) {}
  stillpoint::MovingPoints check(const stillpoint::Frame&, const stillpoint::Frame&,
                                 const stillpoint::TrackingHistory&) override {
    return {};
  }
};

STILLPOINT_PLUGIN(unknown_constructor, "1.0",
                  stillpoint::provide<stillpoint::MovingChecker, Checker>("unknown", "bad"));
