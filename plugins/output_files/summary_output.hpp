// summary.json: the figures of the run, for programs.
#pragma once

#include <filesystem>
#include <stillpoint/sdk.hpp>
#include <stillpoint/support/run_statistics.hpp>

namespace stillpoint::output_files {

class SummaryOutput final : public Output {
 public:
  struct Options {
    std::string file = "summary.json";
    void visit(OptionVisitor& v) {
      v("file", file, {.help = "name of the file in the run folder"});
    }
  };
  SummaryOutput(const Options& options, const StageContext& context)
      : path_(context.output_directory / options.file) {}
  void frame(const FrameReport& report) override { statistics_.add(report.times); }
  void finish(const RunSummary& summary) override;

 private:
  std::filesystem::path path_;
  StageStatistics statistics_;
};

}  // namespace stillpoint::output_files
