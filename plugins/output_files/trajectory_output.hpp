// trajectory.txt: the camera trajectory.
#pragma once

#include <filesystem>
#include <stillpoint/sdk.hpp>

namespace stillpoint::output_files {

/// Poses of the tracked frames. Each follows its reference key frame to where mapping and loop
/// closing have moved it. Frames whose reference never reached the map, because the run was
/// stopped, are left out.
class TrajectoryOutput final : public Output {
 public:
  struct Options {
    std::string file = "trajectory.txt";
    void visit(OptionVisitor& v) {
      v("file", file, {.help = "name of the file in the run folder"});
    }
  };
  TrajectoryOutput(const Options& options, const StageContext& context)
      : path_(context.output_directory / options.file) {}
  void finish(const RunSummary& summary) override;

 private:
  std::filesystem::path path_;
};

}  // namespace stillpoint::output_files
