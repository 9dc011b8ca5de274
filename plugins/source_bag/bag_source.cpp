#include "source_bag/bag_source.hpp"

#include <algorithm>
#include <opencv2/core.hpp>

#include "bag/camera_model.hpp"
#include "bag/depth_extrinsics.hpp"
#include "tum_recording/pairing.hpp"

namespace stillpoint::source_bag {
namespace {

std::unique_ptr<bag::BagReader> opened(const std::string& path) {
  if (path.empty())
    throw Error(Fault::kUsage, "no bag is given", "", "name it with --dataset or as 'path'");
  return bag::open_bag(path);
}

/// Its unit, too: they are those of the camera that the user gives.
void use_depth_range(const CameraModel& of, CameraModel& depth) {
  depth.depth_factor = of.depth_factor;
  depth.min_depth = of.min_depth;
  depth.max_depth = of.max_depth;
}

bool see_the_same(const CameraModel& rectified, const CameraModel& color) {
  return std::ranges::all_of(color.distortion, [](double k) { return k == 0.0; }) &&
         rectified.fx == color.fx && rectified.fy == color.fy && rectified.cx == color.cx &&
         rectified.cy == color.cy;
}

/// Of depth that is registered. Where it is rectified, but colour is not, it is not undistorted
/// with the colour images.
FrameMaker maker_of_registered(const bag::TopicChoice& choice, const CameraModel& color) {
  if (!choice.depth.rectified() || choice.color.rectified()) return FrameMaker(color);
  CameraModel depth = bag::rectified_camera(choice, color);
  if (see_the_same(depth, color)) return FrameMaker(color);
  use_depth_range(color, depth);
  return FrameMaker(color, depth, Pose::Identity());
}

FrameMaker maker_of(bag::BagReader& bag, const bag::TopicChoice& choice,
                    const BagSource::Options& options, const StageContext& context) {
  CameraModel color = context.camera ? *context.camera : bag::camera_in_bag(bag, choice.color);
  if (options.depth_factor > 0)
    color.depth_factor = options.depth_factor;
  else if (!context.camera)
    color.depth_factor = bag::depth_factor_in_bag(bag, choice.depth);
  if (choice.registered() || options.registered) return maker_of_registered(choice, color);
  bag::DepthExtrinsics depth = bag::depth_extrinsics(bag, choice);
  use_depth_range(color, depth.camera);
  return FrameMaker(color, depth.camera, depth.color_from_depth);
}

std::vector<double> times_of(const std::vector<bag::ImageStamp>& stamps) {
  std::vector<double> times;
  for (const bag::ImageStamp& stamp : stamps) times.push_back(stamp.time);
  return times;
}

}  // namespace

void BagSource::Options::visit(OptionVisitor& v) {
  v("path", path,
    {.help = "bag: a .bag, .mcap or .db3 file, or a folder with such files", .is_path = true});
  v("color_topic", topics.color,
    {.help = "topic of the colour images; empty: chosen by type and name"});
  v("depth_topic", topics.depth,
    {.help = "topic of the depth images; empty: chosen by type and name"});
  v("info_topic", topics.info,
    {.help = "topic of the colour camera's CameraInfo; empty: that beside the colour images"});
  v("depth_info_topic", topics.depth_info,
    {.help = "topic of the depth camera's CameraInfo, for depth that is not registered to colour; "
             "empty: that beside the depth images"});
  v("max_difference", max_difference,
    {.min = 0, .max = 10, .unit = "s", .help = "largest time difference of an associated pair"});
  v("time_offset", time_offset,
    {.min = -10, .max = 10, .unit = "s", .help = "added to the depth stamps before pairing"});
  v("registered", registered,
    {.help =
         "take the depth images as registered to colour, although their frame_id says otherwise"});
  v("depth_factor", depth_factor,
    {.min = 0,
     .max = 1e9,
     .help =
         "value of one metre in 16-bit depth images; 0: that of the camera section, or where the "
         "camera comes from the bag 1000 (millimetres), or what a recording of the RealSense "
         "SDK says"});
  selection.visit(v);
}

BagSource::BagSource(Options options, const StageContext& context)
    : bag_(opened(options.path)),
      choice_(bag::choose_topics(*bag_, options.topics)),
      maker_(maker_of(*bag_, choice_, options, context)),
      pairs_(make_pairs(options)),
      skipped_(pairs_.size(), options.path, context.log),
      images_(*bag_, choice_) {
  context.log(LogLevel::kInfo,
              "colour of " + choice_.color.name + ", depth of " + choice_.depth.name +
                  (maker_.registers() ? ", registered to the colour images" : "") + ", camera " +
                  (context.camera ? "'" + context.camera->name + "'"
                                  : "of " + bag_->topics()[*choice_.color.info].name));
  for (const std::string& damage : bag_->damage()) skipped_.warn(damage);
  for (const std::string& note : notes_) skipped_.warn(note);
  if (context.camera && options.depth_factor == 0 && !choice_.depth.first.in_metres())
    check_depth_factor(*context.camera);
}

void BagSource::check_depth_factor(const CameraModel& camera_file) {
  const std::string warning =
      bag::depth_factor_warning(camera_file, bag::depth_factor_in_bag(*bag_, choice_.depth));
  if (!warning.empty()) skipped_.warn(warning);
}

std::vector<BagSource::Pair> BagSource::make_pairs(const Options& options) {
  std::vector<bag::ImageStamps> stamps = bag::image_stamps(*bag_, {choice_.color, choice_.depth});
  std::vector<bag::ImageStamp>& color = stamps[0].images;
  std::vector<bag::ImageStamp>& depth = stamps[1].images;
  notes_ = stamps[0].warnings(choice_.color.name);
  for (std::string& note : stamps[1].warnings(choice_.depth.name))
    notes_.push_back(std::move(note));
  for (bag::ImageStamp& stamp : depth) stamp.time += options.time_offset;
  std::vector<Pair> pairs;
  for (const tum_recording::IndexPair& pair :
       tum_recording::pair_by_time(times_of(color), times_of(depth), options.max_difference))
    pairs.push_back({color[pair.color], depth[pair.depth]});
  if (pairs.empty())
    throw Error(Fault::kData,
                "no colour image of " + choice_.color.name + " has a depth image of " +
                    choice_.depth.name + " within " + std::to_string(options.max_difference) + " s",
                options.path, "change max_difference or time_offset, or choose other topics");
  options.selection.apply(pairs, options.path);
  return pairs;
}

std::optional<Frame> BagSource::next() {
  while (position_ < pairs_.size()) {
    const auto& pair = pairs_[position_++];
    if (auto frame = skipped_.load_or_skip([&] { return load(pair); }, given_)) {
      ++given_;
      return frame;
    }
  }
  return std::nullopt;
}

Frame BagSource::load(const Pair& pair) {
  Frame frame = maker_.frame(pair.color.time, images_.color(pair.color), images_.depth(pair.depth));
  if (cv::countNonZero(frame.depth) == 0)
    throw Error(Fault::kData, "the depth image has no measurement in the range of the camera",
                choice_.depth.name + " at " + std::to_string(pair.depth.time) + " s");
  return frame;
}

}  // namespace stillpoint::source_bag
