#include "bag/topic_choice.hpp"

#include <algorithm>
#include <cctype>
#include <tuple>

#include "bag/registration.hpp"
#include "stillpoint/support/did_you_mean.hpp"

namespace stillpoint::bag {
namespace {

/// Of names such as "Depth_0", too.
bool contains(std::string text, const char* part) {
  std::ranges::transform(text, text.begin(), [](unsigned char letter) {
    return static_cast<char>(std::tolower(letter));
  });
  return text.find(part) != std::string::npos;
}

std::string parent_of(const std::string& name) { return name.substr(0, name.rfind('/')); }

/// Of what a compressed topic is made: "/camera/image_raw" of "/camera/image_raw/compressed".
std::string base_of(const ImageTopic& topic) {
  return topic.first.compressed && contains(topic.name, "/compressed") ? parent_of(topic.name)
                                                                       : topic.name;
}

std::string leaf_of(const ImageTopic& topic) {
  const std::string base = base_of(topic);
  return base.substr(base.rfind('/') + 1);
}

/// Parts of the name that two topics begin with: cameras of one robot have one each.
int shared_parts(const std::string& a, const std::string& b) {
  const auto [end, ignored] = std::mismatch(a.begin(), a.end(), b.begin(), b.end());
  return static_cast<int>(std::count(a.begin(), end, '/'));
}

std::string listed(const std::vector<ImageTopic>& topics) {
  std::string text;
  for (const ImageTopic& topic : topics)
    text += (text.empty() ? "" : ", ") + topic.name + " (" + topic.first.encoding + ")";
  return text.empty() ? "none" : text;
}

/// The only best one by `score`, of those in `topics`.
template <class Score>
ImageTopic best_of(const std::vector<ImageTopic>& topics, const std::string& option, Score score) {
  std::vector<ImageTopic> best;
  for (const ImageTopic& topic : topics) {
    if (!best.empty() && score(topic) > score(best.front())) best.clear();
    if (best.empty() || score(topic) == score(best.front())) best.push_back(topic);
  }
  if (best.size() > 1)
    throw Error(Fault::kUsage, "several topics may be the " + option + ": " + listed(best), "",
                "name one: " + how_to_name(option));
  return best.front();
}

ImageTopic named(const std::vector<ImageTopic>& topics, const std::string& name) {
  std::vector<std::string> names;
  for (const ImageTopic& topic : topics) {
    if (topic.name == name || topic.name == "/" + name) return topic;
    names.push_back(topic.name);
  }
  throw Error(Fault::kUsage,
              "there is no topic of images '" + name + "'" + did_you_mean(name, names), "",
              "those there are: " + listed(topics));
}

std::vector<ImageTopic> of_kind(const std::vector<ImageTopic>& topics, ImageKind kind) {
  std::vector<ImageTopic> result;
  for (const ImageTopic& topic : topics)
    if (topic.first.kind() == kind) result.push_back(topic);
  return result;
}

ImageTopic choose_color(const std::vector<ImageTopic>& topics) {
  std::vector<ImageTopic> candidates = of_kind(topics, ImageKind::kColor);
  if (candidates.empty()) candidates = of_kind(topics, ImageKind::kGray);
  if (candidates.empty())
    throw Error(Fault::kUsage, "there is no topic with colour images", "",
                "topics with images: " + listed(topics));
  return best_of(candidates, "color_topic", [](const ImageTopic& topic) {
    const std::string& name = topic.name;
    const bool other = contains(name, "infra") || contains(name, "fisheye") ||
                       contains(name, "depth") || contains(name, "/ir/");
    return std::tuple(!other, contains(name, "color") || contains(name, "rgb"), !topic.rectified(),
                      !topic.first.compressed);
  });
}

ImageTopic choose_depth(const std::vector<ImageTopic>& topics, const ImageTopic& color) {
  const std::vector<ImageTopic> candidates = of_kind(topics, ImageKind::kDepth);
  if (candidates.empty())
    throw Error(Fault::kUsage, "there is no topic with depth images", "",
                "topics with images: " + listed(topics));
  return best_of(candidates, "depth_topic", [&](const ImageTopic& topic) {
    return std::tuple(contains(topic.name, "depth"),
                      topic.first.header.frame == color.first.header.frame,
                      says_registered(topic.name), shared_parts(topic.name, color.name),
                      topic.rectified() == color.rectified(), !topic.first.compressed);
  });
}

/// Beside the images; of a recording of the RealSense SDK, "…/Color_0/info/camera_info" of
/// "…/Color_0/image/data".
std::vector<std::string> usual_info_names(const ImageTopic& images) {
  const std::string folder = parent_of(base_of(images));
  return {folder + "/camera_info", parent_of(folder) + "/info/camera_info"};
}

/// The camera info of the images, or that of the given name.
std::optional<std::uint32_t> choose_info(BagReader& bag, const ImageTopic& images,
                                         const std::string& name) {
  const std::vector<Topic>& topics = bag.topics();
  for (const std::string& wanted : name.empty() ? usual_info_names(images) : std::vector{name})
    for (std::uint32_t i = 0; i < topics.size(); ++i)
      if (topics[i].type == kCameraInfoType &&
          (topics[i].name == wanted || topics[i].name == "/" + wanted))
        return i;
  if (name.empty()) return std::nullopt;
  std::vector<std::string> names;
  for (const Topic& topic : topics)
    if (topic.type == kCameraInfoType) names.push_back(topic.name);
  throw Error(Fault::kUsage,
              "there is no topic of camera infos '" + name + "'" + did_you_mean(name, names), "",
              "those there are: " + (names.empty() ? "none" : join(names)));
}

std::optional<CameraInfoMessage> first_camera_info(BagReader& bag,
                                                   std::optional<std::uint32_t> info) {
  for (const MessagePlace& place : bag.messages()) {
    if (place.topic != info) continue;
    try {
      return read_camera_info(bag.read(place), bag.topics()[place.topic].serialisation);
    } catch (const Error&) {  // a damaged one; the next may do
    }
  }
  return std::nullopt;
}

void find_camera(BagReader& bag, ImageTopic& images, const std::string& name) {
  images.info = choose_info(bag, images, name);
  images.camera = first_camera_info(bag, images.info);
}

ImageOrigin origin_of(const ImageTopic& images) {
  return {images.name, images.first.header.frame, images.camera};
}

}  // namespace

bool TopicChoice::registered() const { return is_registered(origin_of(color), origin_of(depth)); }

bool ImageTopic::rectified() const { return contains(leaf_of(*this), "rect"); }

std::string how_to_name(const std::string& option) {
  std::string flag = option;
  std::ranges::replace(flag, '_', '-');
  return "--set source." + option + "=NAME for run, --" + flag + " NAME for inspect";
}

std::vector<ImageTopic> image_topics(BagReader& bag) {
  constexpr std::size_t kBegin = 4096;  // bytes: a description and more
  std::vector<ImageTopic> result;
  std::vector<bool> done(bag.topics().size());
  for (const MessagePlace& message : bag.messages()) {
    if (done[message.topic]) continue;
    const Topic& topic = bag.topics()[message.topic];
    const bool compressed = topic.type == kCompressedImageType;
    done[message.topic] =
        topic.serialisation == Serialisation::kOther || (topic.type != kImageType && !compressed);
    if (done[message.topic]) continue;
    try {
      result.push_back(
          {message.topic, topic.name,
           describe_image(bag.read(message, kBegin), topic.serialisation, compressed)});
      done[message.topic] = true;
    } catch (const Error&) {  // a damaged one; the next may do
    }
  }
  std::ranges::sort(result, {}, &ImageTopic::name);
  return result;
}

TopicChoice choose_topics(BagReader& bag, const TopicNames& names) {
  const std::vector<ImageTopic> topics = image_topics(bag);
  TopicChoice choice;
  choice.color = names.color.empty() ? choose_color(topics) : named(topics, names.color);
  choice.depth =
      names.depth.empty() ? choose_depth(topics, choice.color) : named(topics, names.depth);
  find_camera(bag, choice.color, names.info);
  find_camera(bag, choice.depth, names.depth_info);
  return choice;
}

}  // namespace stillpoint::bag
