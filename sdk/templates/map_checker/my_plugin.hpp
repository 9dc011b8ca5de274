// Map checker `my_plugin`: depth compared with that of an earlier frame.
#pragma once

#include <deque>
#include <stillpoint/sdk.hpp>

namespace plugins::my_plugin {

class MyPlugin final : public stillpoint::MapChecker {
 public:
  struct Options {
    int age = 10;
    int cell = 8;
    double tolerance = 0.1;
    double log_odds = 2.0;

    void visit(stillpoint::OptionVisitor& v) {
      v("age", age, {.min = 1, .max = 300, .unit = "frames", .help = "of the frame compared with"});
      v("cell", cell, {.min = 1, .max = 64, .unit = "px", .help = "side of a cell"});
      v("tolerance", tolerance,
        {.min = 0.001,
         .unit = "m",
         .help = "surfaces nearer to each other than this are the same"});
      v("log_odds", log_odds, {.min = 0, .max = 20, .help = "of a cell that moves, or does not"});
    }
  };

  explicit MyPlugin(Options options) : options_(options) {}

  stillpoint::MapEvidence check(const stillpoint::Frame& frame,
                                std::span<const stillpoint::Pose> guesses,
                                const stillpoint::SparseMap& map) override;
  void remember(const stillpoint::TrackedFrame& frame) override;
  void clear() override { earlier_.clear(); }

 private:
  Options options_;
  std::deque<stillpoint::TrackedFrame> earlier_;  // oldest first, at most `age`
};

}  // namespace plugins::my_plugin
