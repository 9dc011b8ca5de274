// keyframes.txt: the key frames of the finished map.
#pragma once

#include <filesystem>
#include <stillpoint/sdk.hpp>

namespace stillpoint::output_files {

class KeyFramesOutput final : public Output {
 public:
  struct Options {
    std::string file = "keyframes.txt";
    void visit(OptionVisitor& v) {
      v("file", file, {.help = "name of the file in the run folder"});
    }
  };
  KeyFramesOutput(const Options& options, const StageContext& context)
      : path_(context.output_directory / options.file) {}
  void finish(const RunSummary& summary) override;

 private:
  std::filesystem::path path_;
};

}  // namespace stillpoint::output_files
