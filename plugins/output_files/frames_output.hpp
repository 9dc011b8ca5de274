// frames.csv: what tracking had of every frame, and what it left out.
#pragma once

#include <stillpoint/sdk.hpp>

#include "stillpoint/support/atomic_file.hpp"

namespace stillpoint::output_files {

/// Written as the run goes, so that memory does not grow with it.
class FramesOutput final : public Output {
 public:
  struct Options {
    std::string file = "frames.csv";
    void visit(OptionVisitor& v) {
      v("file", file, {.help = "name of the file in the run folder"});
    }
  };
  FramesOutput(const Options& options, const StageContext& context);
  void frame(const FrameReport& report) override;
  void finish(const RunSummary&) override { file_.commit(); }

 private:
  AtomicFile file_;
};

}  // namespace stillpoint::output_files
