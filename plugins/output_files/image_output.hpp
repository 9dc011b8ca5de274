// images/: pictures of what the pipeline saw, as in the rows of the paper's Fig. 5.
#pragma once

#include <filesystem>
#include <stillpoint/sdk.hpp>

#include "output_files/annotation.hpp"

namespace stillpoint::output_files {

class ImageOutput final : public Output {
 public:
  struct Options {
    enum class Format { kPng, kJpeg };
    int every = 30;
    Format format = Format::kJpeg;
    AnnotationParts parts;
    std::string folder = "images";

    void visit(OptionVisitor& v) {
      v("every", every,
        {.min = 1, .max = 1e6, .unit = "frames", .help = "one picture per so many"});
      v.choice("format", format, {{"png", Format::kPng}, {"jpeg", Format::kJpeg}},
               {.help = "of the files"});
      v("features", parts.features,
        {.help = "features: green fits the pose, yellow does not, orange moves, grey unmatched"});
      v("moving", parts.moving, {.help = "moving points, with a line from where they were"});
      v("mask", parts.mask, {.help = "labelled things in blue, red what is not tracked on"});
      v("evidence", parts.evidence,
        {.help = "of the map check: purple what has come in, light blue what stands still"});
      v("text", parts.text, {.help = "a line with the state of tracking"});
      v("folder", folder, {.help = "name of the folder in the run folder"});
    }
  };
  ImageOutput(const Options& options, const StageContext& context);
  void frame(const FrameReport& report) override;

 private:
  Options options_;
  std::filesystem::path folder_;
  bool begun_ = false;  // until then the folder is an earlier run's
};

}  // namespace stillpoint::output_files
