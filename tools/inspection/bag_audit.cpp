#include "inspection/bag_audit.hpp"

#include <algorithm>

#include "bag/bag_images.hpp"
#include "bag/camera_model.hpp"
#include "bag/depth_extrinsics.hpp"
#include "inspection/audit_warnings.hpp"
#include "stillpoint/error.hpp"
#include "stillpoint/support/bag_files.hpp"
#include "stillpoint/support/size_text.hpp"
#include "tum_recording/image_decoder.hpp"
#include "tum_recording/pairing.hpp"

namespace stillpoint::inspection {
namespace {

std::vector<TopicAudit> audit_topics(bag::BagReader& bag) {
  std::vector<std::vector<double>> times(bag.topics().size());
  for (const bag::MessagePlace& place : bag.messages())
    times[place.topic].push_back(bag::seconds(place.time));
  std::vector<TopicAudit> topics;
  for (std::size_t i = 0; i < times.size(); ++i)
    topics.push_back({bag.topics()[i], audit_stream(times[i]), {}});
  for (const bag::ImageTopic& topic : bag::image_topics(bag)) {
    const bag::ImageDescription& first = topic.first;
    topics[topic.index].images =
        (first.compressed ? "" : size_text({first.width, first.height}) + ", ") + first.encoding;
  }
  std::ranges::sort(topics, {}, [](const TopicAudit& topic) { return topic.topic.name; });
  return topics;
}

std::vector<double> times_of(const std::vector<bag::ImageStamp>& images) {
  std::vector<double> times;
  for (const bag::ImageStamp& image : images) times.push_back(image.time);
  return times;
}

void add_warnings(const std::vector<std::string>& lines, BagAudit& audit) {
  audit.warnings.insert(audit.warnings.end(), lines.begin(), lines.end());
}

/// What `find` lacks is a warning.
template <class Function>
void unless_missing(BagAudit& audit, Function find) {
  try {
    find();
  } catch (const Error& error) {
    audit.warnings.emplace_back(error.what());
  }
}

void find_cameras(bag::BagReader& bag, const BagAuditOptions& options, BagAudit& audit) {
  unless_missing(audit, [&] {
    audit.camera = options.camera ? *options.camera : bag::camera_in_bag(bag, audit.choice->color);
  });
  audit.depth_factor = options.camera ? options.camera->depth_factor
                                      : bag::depth_factor_in_bag(bag, audit.choice->depth);
  if (audit.choice->registered()) return;
  unless_missing(audit, [&] {
    const bag::DepthExtrinsics depth = bag::depth_extrinsics(bag, *audit.choice);
    audit.depth_camera = depth.camera;
    audit.color_from_depth = depth.color_from_depth;
  });
}

/// "jpeg compressed bgr8" of "rgb8; jpeg compressed bgr8".
std::string format_of(const bag::ImageTopic& topic) {
  const std::string& encoding = topic.first.encoding;
  const auto end = encoding.find("; ");
  return end == std::string::npos ? encoding : encoding.substr(end + 2);
}

/// What a run would do with the bag.
void audit_choice(bag::BagReader& bag, const BagAuditOptions& options, BagAudit& audit) {
  const bag::TopicChoice& choice = *audit.choice;
  find_cameras(bag, options, audit);
  auto stamps = bag::image_stamps(bag, {choice.color, choice.depth});
  const std::vector<bag::ImageStamp>& color = stamps[0].images;
  std::vector<bag::ImageStamp>& depth = stamps[1].images;
  for (bag::ImageStamp& image : depth) image.time += options.time_offset;
  const auto indices =
      tum_recording::pair_by_time(times_of(color), times_of(depth), options.max_difference);
  std::vector<PairStamps> pairs;
  for (const auto& pair : indices)
    pairs.push_back({color[pair.color].time, depth[pair.depth].time});
  audit_stamps(times_of(color), times_of(depth), pairs, audit);
  bag::BagImages<tum_recording::ImageDecoder> images(bag, choice);
  const auto read_color = [&](std::size_t i) {
    return RecordedImage{images.color(color[indices[i].color]), format_of(choice.color)};
  };
  const auto read_depth = [&](std::size_t i) {
    return RecordedImage{images.depth(depth[indices[i].depth]), format_of(choice.depth)};
  };
  audit_images(pairs, {read_color, read_depth}, options.samples, audit);
  add_warnings(stamps[0].warnings(choice.color.name), audit);
  add_warnings(stamps[1].warnings(choice.depth.name), audit);
  add_warnings(pair_warnings(audit, options.max_difference,
                             time_offset_advice(options.time_offset + audit.time_offset.offset)),
               audit);
}

}  // namespace

BagAudit audit_bag(const std::filesystem::path& path, const BagAuditOptions& options) {
  const auto bag = bag::open_bag(path);
  BagAudit audit;
  audit.path = path;
  audit.format = bag->format();
  audit.topics = audit_topics(*bag);
  for (const auto& file : bag_files(path)) audit.bytes += std::filesystem::file_size(file);
  unless_missing(audit, [&] { audit.choice = bag::choose_topics(*bag, options.topics); });
  if (audit.choice) audit_choice(*bag, options, audit);
  add_warnings(bag->damage(), audit);
  return audit;
}

}  // namespace stillpoint::inspection
