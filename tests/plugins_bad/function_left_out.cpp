// Must not compile: remember() is left out. The constructor is not to blame.
#include "stillpoint/sdk.hpp"

class Forgetful final : public stillpoint::MapChecker {
 public:
  struct Options {
    int cell = 16;
    void visit(stillpoint::OptionVisitor& v) { v("cell", cell, {.min = 1}); }
  };
  explicit Forgetful(Options options) : options_(options) {}
  stillpoint::MapEvidence check(const stillpoint::Frame&, std::span<const stillpoint::Pose>,
                                const stillpoint::SparseMap&) override {
    return {};
  }

 private:
  Options options_;
};

STILLPOINT_PLUGIN(forgetful, "1", stillpoint::provide<stillpoint::MapChecker, Forgetful>("x", "y"));
