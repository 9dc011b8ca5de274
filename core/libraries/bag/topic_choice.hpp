// Which topics of a bag are the colour and depth images and their cameras.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bag/bag_reader.hpp"
#include "bag/messages.hpp"

namespace stillpoint::bag {

/// Names of topics; those that are empty are found.
struct TopicNames {
  std::string color, depth;
  std::string info, depth_info;  ///< the CameraInfo of either
};

/// A topic with images, by its first one.
struct ImageTopic {
  std::uint32_t index = 0;  ///< in BagReader::topics()
  std::string name;
  ImageDescription first;
  std::optional<std::uint32_t> info = {};  ///< index of their CameraInfo; nothing: there is none
  std::optional<CameraInfoMessage> camera = {};  ///< the first of these that can be read

  /// By the name ("image_rect_color").
  bool rectified() const;
};

struct TopicChoice {
  ImageTopic color, depth;

  /// Whether depth is seen from the colour camera, as is_registered() says.
  bool registered() const;
};

/// How a topic is named that is the source's `option` ("color_topic"): in the commands that use it.
std::string how_to_name(const std::string& option);

/// The topics with images that can be read; their cameras are not looked for.
std::vector<ImageTopic> image_topics(BagReader& bag);

/// Prefers depth that is registered to the colour images, and images that are not compressed.
/// Throws Error(kUsage) when there is no such topic, when several fit equally well, or when a name
/// that is given is not there; the message lists those to choose from.
TopicChoice choose_topics(BagReader& bag, const TopicNames& names);

}  // namespace stillpoint::bag
