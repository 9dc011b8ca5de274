// images/: annotated frames, as in the rows of the paper's Fig. 5.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <stillpoint/sdk.hpp>
#include <vector>

#include "output_files/annotation.hpp"
#include "output_files/worst_frames.hpp"

namespace stillpoint::output_files {

class ImageOutput final : public Output {
 public:
  struct Options {
    enum class Format { kPng, kJpeg };
    int every = 30;
    std::vector<double> frames;
    int worst = 0;
    Format format = Format::kJpeg;
    AnnotationParts parts;
    bool panels = false;
    std::string folder = "images";

    void visit(OptionVisitor& v) {
      v("every", every,
        {.min = 1, .max = 1e6, .unit = "frames", .help = "write one picture per so many"});
      v("frames", frames, {.min = 0, .help = "indices of frames that also have a picture"});
      v("worst", worst,
        {.min = 0,
         .max = 100,
         .help = "so many frames each also have a picture: where most was excluded, where fewest "
                 "features fitted, where tracking was lost"});
      v.choice("format", format, {{"png", Format::kPng}, {"jpeg", Format::kJpeg}},
               {.help = "file format of the pictures"});
      v("features", parts.features,
        {.help = "features: inliers green, outliers yellow, moving orange, unmatched grey"});
      v("moving", parts.moving, {.help = "moving points, with a line from where they were"});
      v("mask", parts.mask, {.help = "labelled objects blue, pixels excluded from tracking red"});
      v("evidence", parts.evidence,
        {.help = "evidence of the map check: free-space violations purple, static surfaces light "
                 "blue"});
      v("text", parts.text, {.help = "a line with the state of tracking"});
      v("panels", panels,
        {.help = "four pictures in one, whatever the parts: features, moving points, labels with "
                 "what was decided, and what tracking uses"});
      v("folder", folder, {.help = "name of the folder in the run folder"});
      v.require(!folder.empty() && std::filesystem::path(folder).is_relative() &&
                    !folder.starts_with(".") && folder.find("..") == std::string::npos,
                "folder must be a name below the run folder, as pictures in it are replaced");
    }
  };
  ImageOutput(const Options& options, const StageContext& context);
  void frame(const FrameReport& report) override;
  void finish(const RunSummary& summary) override;

 private:
  std::filesystem::path file_of(std::uint32_t frame) const;
  bool is_chosen(std::uint32_t frame) const;
  void write(const FrameReport& report) const;
  void take(const WorstFrames::Change& change);

  Options options_;
  std::filesystem::path folder_;
  bool begun_ = false;  // whether pictures of an earlier run have been removed
  std::vector<WorstFrames> worst_;
  std::map<std::uint32_t, int> reasons_;  // by frame: how often it is one of the worst
};

}  // namespace stillpoint::output_files
