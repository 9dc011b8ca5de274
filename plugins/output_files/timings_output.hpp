// timings.csv: wall and CPU time of every stage for every frame.
#pragma once

#include <span>
#include <stillpoint/sdk.hpp>

#include "stillpoint/support/atomic_file.hpp"

namespace stillpoint::output_files {

/// Written as the run goes, so that memory does not grow with it. Rows are in the order in which
/// stages ended.
class TimingsOutput final : public Output {
 public:
  struct Options {
    std::string file = "timings.csv";
    void visit(OptionVisitor& v) {
      v("file", file, {.help = "name of the file in the run folder"});
    }
  };
  TimingsOutput(const Options& options, const StageContext& context);
  void frame(const FrameReport& report) override { write(report.times); }
  void finish(const RunSummary& summary) override;

 private:
  void write(std::span<const StageTime> times);

  AtomicFile file_;
};

}  // namespace stillpoint::output_files
