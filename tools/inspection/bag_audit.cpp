#include "inspection/bag_audit.hpp"

#include <algorithm>
#include <cmath>

#include "bag/camera_model.hpp"
#include "bag/image_stamps.hpp"
#include "inspection/number_text.hpp"
#include "stillpoint/error.hpp"
#include "stillpoint/support/bag_files.hpp"
#include "stillpoint/support/size_text.hpp"
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

std::vector<double> stamps_of(const bag::ImageStamps& stamps, double offset) {
  std::vector<double> times;
  for (const bag::ImageStamp& stamp : stamps.images) times.push_back(stamp.time + offset);
  return times;
}

void audit_pairs(const std::vector<double>& color, const std::vector<double>& depth,
                 double max_difference, BagAudit& audit) {
  std::vector<double> times;
  for (const auto& pair : tum_recording::pair_by_time(color, depth, max_difference)) {
    const double difference = std::abs(color[pair.color] - depth[pair.depth]);
    audit.max_difference = std::max(audit.max_difference, difference);
    audit.mean_difference += difference;
    times.push_back(color[pair.color]);
  }
  audit.mean_difference /= static_cast<double>(std::max<std::size_t>(1, times.size()));
  audit.pairs = audit_stream(times);
}

void warn_of_pairs(double max_difference, BagAudit& audit) {
  const std::size_t unpaired = audit.color.images - audit.pairs.images;
  if (unpaired * 20 > audit.color.images)
    audit.warnings.push_back(
        std::to_string(unpaired) + " of " + std::to_string(audit.color.images) +
        " colour images have no depth image within " + fixed(1e3 * max_difference, 0) +
        " ms; change max_difference or time_offset of the source");
  if (audit.pairs.gaps.empty() || audit.pairs.gaps[0].length < 0.5) return;
  audit.warnings.push_back("no frames for " + fixed(audit.pairs.gaps[0].length, 2) + " s from " +
                           fixed(audit.pairs.gaps[0].begin, 3) + " s; tracking may get lost there");
}

/// What a run would do with the bag.
void audit_images(bag::BagReader& bag, const BagAuditOptions& options, BagAudit& audit) {
  const bag::TopicChoice& choice = *audit.choice;
  if (!choice.registered())
    audit.warnings.push_back("depth of " + choice.depth.name + " is in the frame '" +
                             choice.depth.first.header.frame + "', colour in '" +
                             choice.color.first.header.frame +
                             "'; record registered depth, or, if it is, set source.registered");
  const auto stamps = bag::image_stamps(bag, {choice.color, choice.depth});
  const auto color = stamps_of(stamps[0], 0.0);
  const auto depth = stamps_of(stamps[1], options.time_offset);
  audit.color = audit_stream(color);
  audit.depth = audit_stream(depth);
  audit_pairs(color, depth, options.max_difference, audit);
  for (const auto& lines :
       {stamps[0].warnings(choice.color.name), stamps[1].warnings(choice.depth.name)})
    audit.warnings.insert(audit.warnings.end(), lines.begin(), lines.end());
  warn_of_pairs(options.max_difference, audit);
}

}  // namespace

BagAudit audit_bag(const std::filesystem::path& path, const BagAuditOptions& options) {
  const auto bag = bag::open_bag(path);
  BagAudit audit{.path = path, .format = bag->format(), .topics = audit_topics(*bag)};
  for (const auto& file : bag_files(path)) audit.bytes += std::filesystem::file_size(file);
  try {
    audit.choice = bag::choose_topics(*bag, options.topics);
    audit_images(*bag, options, audit);
    audit.camera = options.camera ? *options.camera : bag::camera_in_bag(*bag, *audit.choice);
  } catch (const Error& error) {
    audit.warnings.insert(audit.warnings.begin(), error.what());
  }
  for (std::string& damage : bag->damage()) audit.warnings.push_back(std::move(damage));
  return audit;
}

}  // namespace stillpoint::inspection
