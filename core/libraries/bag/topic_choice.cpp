#include "bag/topic_choice.hpp"

#include <algorithm>
#include <tuple>

#include "stillpoint/support/did_you_mean.hpp"

namespace stillpoint::bag {
namespace {

bool contains(const std::string& text, const char* part) {
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

bool says_registered(const std::string& name) {
  return contains(name, "registered") || contains(name, "aligned");
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
                "name one with --set source." + option + "=NAME");
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

/// The camera info beside the images, or that of the given name.
std::optional<std::uint32_t> choose_info(BagReader& bag, const ImageTopic& images,
                                         const std::string& name) {
  const std::string wanted = name.empty() ? parent_of(base_of(images)) + "/camera_info" : name;
  std::vector<std::string> names;
  for (std::uint32_t i = 0; i < bag.topics().size(); ++i) {
    const Topic& topic = bag.topics()[i];
    if (topic.type != kCameraInfoType) continue;
    if (topic.name == wanted || topic.name == "/" + wanted) return i;
    names.push_back(topic.name);
  }
  if (!name.empty())
    throw Error(Fault::kUsage,
                "there is no topic of camera infos '" + name + "'" + did_you_mean(name, names), "",
                "those there are: " + (names.empty() ? "none" : join(names)));
  return std::nullopt;
}

}  // namespace

bool TopicChoice::registered() const {
  return color.first.header.frame == depth.first.header.frame || says_registered(depth.name);
}

bool ImageTopic::rectified() const { return contains(leaf_of(*this), "rect"); }

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
  choice.color.info = choose_info(bag, choice.color, names.info);
  choice.depth.info = choose_info(bag, choice.depth, names.depth_info);
  return choice;
}

}  // namespace stillpoint::bag
