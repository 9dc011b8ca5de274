#include "bag/realsense_recording.hpp"

#include <cmath>
#include <map>
#include <string_view>

#include "bag/messages.hpp"

namespace stillpoint::bag {
namespace {

/// Calls `use` with the messages of a type whose topics begin like this, and with the rest of the
/// topic's name. Damaged ones are left out.
template <class Use>
void for_each_message(BagReader& bag, std::string_view type, const std::string& begin, Use use) {
  for (const MessagePlace& place : bag.messages()) {
    const Topic& topic = bag.topics()[place.topic];
    if (topic.type != type || !topic.name.starts_with(begin)) continue;
    try {
      use(bag.read(place), topic.serialisation, topic.name.substr(begin.size()));
    } catch (const Error&) {  // a damaged one
    }
  }
}

/// The pose of a stream's camera for each group of streams, by its number: of a point in the
/// group's first stream to one in this stream, as rs2_extrinsics are.
std::map<std::string, Pose> stream_from_group(BagReader& bag, const std::string& stream) {
  std::map<std::string, Pose> poses;
  for_each_message(bag, kOneTransformType, stream + "/tf/",
                   [&](ByteSpan message, Serialisation serialisation, const std::string& group) {
                     if (const auto pose = read_transform(message, serialisation))
                       poses.try_emplace(group, *pose);
                   });
  return poses;
}

}  // namespace

std::string realsense_stream(const std::string& images) {
  constexpr std::string_view kDevice = "/device_", kSensor = "/sensor_", kImages = "/image/data";
  const bool is_one = images.starts_with(kDevice) && images.ends_with(kImages) &&
                      images.find(kSensor) != std::string::npos;
  return is_one ? images.substr(0, images.size() - kImages.size()) : "";
}

std::optional<Pose> realsense_color_from_depth(BagReader& bag, const std::string& color,
                                               const std::string& depth) {
  const std::string color_stream = realsense_stream(color);
  const std::string depth_stream = realsense_stream(depth);
  if (color_stream.empty() || depth_stream.empty()) return std::nullopt;
  const auto of_depth = stream_from_group(bag, depth_stream);
  for (const auto& [group, color_from_group] : stream_from_group(bag, color_stream))
    if (const auto same = of_depth.find(group); same != of_depth.end())
      return color_from_group * same->second.inverse();
  return std::nullopt;
}

std::optional<double> realsense_depth_factor(BagReader& bag, const std::string& depth) {
  constexpr double kFloat = 1e-6;  // relative: what 32 bits know of 0.001
  const std::string stream = realsense_stream(depth);
  if (stream.empty()) return std::nullopt;
  const std::string option = stream.substr(0, stream.rfind('/')) + "/option/Depth Units/value";
  std::optional<double> factor;
  for_each_message(bag, kFloatType, option,
                   [&](ByteSpan message, Serialisation serialisation, const std::string&) {
                     const double unit = read_float(message, serialisation);  // metres
                     if (factor || !(unit > 0) || !std::isfinite(1 / unit)) return;
                     const double whole = std::round(1 / unit);
                     factor = std::abs(whole * unit - 1) < kFloat ? whole : 1 / unit;
                   });
  return factor;
}

}  // namespace stillpoint::bag
