#include "source_tum/tum_source.hpp"

#include <opencv2/core.hpp>
#include "stillpoint/support/size_text.hpp"

namespace stillpoint::source_tum {
namespace {

using tum_recording::open_recording;
using tum_recording::PairsFrom;

CameraModel required_camera(const StageContext& context) {
  if (context.camera) return *context.camera;
  throw Error(Fault::kUsage, "no camera is given", "",
              "name one of configs/cameras with --camera, such as --camera tum_fr1, or add a "
              "'camera:' section to the pipeline file");
}

Recording selected_recording(const TumSource::Options& options) {
  if (options.path.empty())
    throw Error(Fault::kUsage, "no recording is given", "",
                "name its folder with --dataset or as 'path'");
  Recording recording = open_recording(options.path, options.pairing);
  options.selection.apply(recording.pairs, options.path);
  return recording;
}

void check_size(const cv::Mat& image, const CameraModel& model, const std::filesystem::path& file) {
  if (image.cols == model.width && image.rows == model.height) return;
  throw Error(Fault::kData,
              "the image has " + size_text(image.size()) + " pixels, but camera '" + model.name +
                  "' has " + size_text({model.width, model.height}),
              file.string(), "choose the camera of this recording with --camera");
}

}  // namespace

void TumSource::Options::visit(OptionVisitor& v) {
  v("path", path, {.help = "folder of the recording", .is_path = true});
  v("max_difference", pairing.max_difference,
    {.min = 0, .max = 10, .unit = "s", .help = "largest time difference of an associated pair"});
  v("time_offset", pairing.time_offset,
    {.min = -10,
     .max = 10,
     .unit = "s",
     .help = "added to the depth stamps of depth.txt before pairing"});
  v.choice("prefer", pairing.prefer,
           {{"lists", PairsFrom::kLists}, {"associations", PairsFrom::kAssociations}},
           {.help = "what to use where both exist: rgb.txt and depth.txt, or associations.txt"});
  selection.visit(v);
}

TumSource::TumSource(Options options, const StageContext& context)
    : recording_(selected_recording(options)),
      model_(required_camera(context)),
      rectifier_(model_),
      skipped_(recording_.pairs.size(), recording_.folder.string(), context.log) {
  for (const std::string& warning : recording_.warnings) skipped_.warn(warning);
}

std::optional<Frame> TumSource::next() {
  while (position_ < recording_.pairs.size()) {
    const auto& pair = recording_.pairs[position_++];
    if (auto frame = skipped_.load_or_skip([&] { return load(pair); }, given_)) {
      ++given_;
      return frame;
    }
  }
  return std::nullopt;
}

Frame TumSource::load(const ImagePair& pair) {
  const cv::Mat recorded_color = reader_.color(pair.color.file);
  check_size(recorded_color, model_, pair.color.file);
  const cv::Mat recorded_depth = reader_.depth(pair.depth.file);
  check_size(recorded_depth, model_, pair.depth.file);
  if (cv::countNonZero(recorded_depth) == 0)
    throw Error(Fault::kData, "the depth image has no measurement", pair.depth.file.string());
  return rectifier_.frame(pair.color.time, recorded_color, recorded_depth);
}

}  // namespace stillpoint::source_tum
