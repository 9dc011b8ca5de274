#include "source_tum/tum_source.hpp"

#include <algorithm>
#include <opencv2/core.hpp>
#include "stillpoint/support/size_text.hpp"

namespace stillpoint::source_tum {
namespace {

using tum_recording::open_recording;
using tum_recording::PairsFrom;

constexpr std::size_t kMaxUnusableAtStart = 10;  // unusable pairs before the first usable one
constexpr std::size_t kMaxReportedImages = 20;

CameraModel required_camera(const StageContext& context) {
  if (context.camera) return *context.camera;
  throw Error(Fault::kUsage, "no camera is given", "",
              "name one of configs/cameras with --camera, such as --camera tum_fr1, or add a "
              "'camera:' section to the pipeline file");
}

/// Keeps the pairs that `options` selects.
void select(std::vector<ImagePair>& pairs, const TumSource::Options& options) {
  const std::size_t count = pairs.size();
  const std::size_t end = options.end > 0 ? std::min<std::size_t>(options.end, count) : count;
  std::vector<ImagePair> selected;
  for (std::size_t i = options.start; i < end; i += options.stride) {
    if (options.limit > 0 && selected.size() == static_cast<std::size_t>(options.limit)) break;
    selected.push_back(std::move(pairs[i]));
  }
  if (selected.empty())
    throw Error(
        Fault::kUsage,
        "no frames are selected of the " + std::to_string(count) + " pairs of the recording",
        options.path, "change start, end, stride or limit");
  pairs = std::move(selected);
}

Recording selected_recording(const TumSource::Options& options) {
  if (options.path.empty())
    throw Error(Fault::kUsage, "no recording is given", "",
                "name its folder with --dataset or as 'path'");
  Recording recording = open_recording(options.path, options.pairing);
  select(recording.pairs, options);
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
  v("start", start, {.min = 0, .unit = "pairs", .help = "first pair to use"});
  v("end", end, {.min = 0, .unit = "pairs", .help = "one past the last pair; 0 for all"});
  v("stride", stride, {.min = 1, .unit = "pairs", .help = "use every n-th pair"});
  v("limit", limit, {.min = 0, .unit = "frames", .help = "most frames to read; 0 for no limit"});
}

TumSource::TumSource(Options options, const StageContext& context)
    : recording_(selected_recording(options)),
      model_(required_camera(context)),
      rectifier_(model_),
      log_(context.log) {
  report_.warnings = recording_.warnings;
  for (const std::string& warning : report_.warnings) log_(LogLevel::kWarning, warning);
}

std::optional<Frame> TumSource::next() {
  while (position_ < recording_.pairs.size()) {
    try {
      Frame frame = load(recording_.pairs[position_++]);
      frame.index = given_++;
      return frame;
    } catch (const Error& reason) {
      skip(reason);
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

void TumSource::skip(const Error& reason) {
  ++report_.skipped;
  const std::size_t total = recording_.pairs.size();
  const bool hopeless = given_ == 0 && report_.skipped >= std::min(kMaxUnusableAtStart, total);
  if (hopeless || 2 * report_.skipped > total)
    throw Error(
        Fault::kData,
        (hopeless
             ? "none of the first " + std::to_string(report_.skipped) + " image pairs can be used"
             : "more than half of the " + std::to_string(total) + " image pairs cannot be used") +
            "; the last one: " + reason.what(),
        recording_.folder.string());
  const std::string warning = std::string("skipped: ") + reason.what();
  log_(LogLevel::kWarning, warning);
  if (report_.skipped <= kMaxReportedImages) report_.warnings.push_back(warning);
  if (report_.skipped == kMaxReportedImages + 1)
    report_.warnings.push_back("more images were skipped; the log names them");
}

}  // namespace stillpoint::source_tum
