// Must not compile: options that no constructor takes.
#include "stillpoint/sdk.hpp"

struct Checker final : stillpoint::MovingChecker {
  struct Options {
    int points = 0;
    void visit(stillpoint::OptionVisitor& v) { v("points", points, {.help = "points"}); }
  };
  stillpoint::MovingPoints check(const stillpoint::Frame&, const stillpoint::Frame&,
                                 const stillpoint::TrackingHistory&) override {
    return {};
  }
};

STILLPOINT_PLUGIN(lost_options, "1.0",
                  stillpoint::provide<stillpoint::MovingChecker, Checker>("lost", "bad"));
