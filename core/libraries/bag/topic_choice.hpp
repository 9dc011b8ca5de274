// Which topics of a bag are the colour and depth images and the camera.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bag/bag_reader.hpp"
#include "bag/messages.hpp"

namespace stillpoint::bag {

/// Names of topics; those that are empty are found.
struct TopicNames {
  std::string color, depth, info;
};

/// A topic with images, by its first one.
struct ImageTopic {
  std::uint32_t index = 0;  ///< in BagReader::topics()
  std::string name;
  ImageDescription first;
};

struct TopicChoice {
  ImageTopic color, depth;
  std::optional<std::uint32_t> info;  ///< index of the topic; nothing when there is none

  /// Whether depth is seen from the colour camera, by the frames of both or by the name of depth.
  bool registered() const;
  /// Whether the colour images are rectified, by their name ("image_rect_color").
  bool rectified() const;
};

/// The topics with images that can be read.
std::vector<ImageTopic> image_topics(BagReader& bag);

/// Prefers depth that is registered to the colour images, and images that are not compressed.
/// Throws Error(kUsage) when there is no such topic, when several fit equally well, or when a name
/// that is given is not there; the message lists those to choose from.
TopicChoice choose_topics(BagReader& bag, const TopicNames& names);

}  // namespace stillpoint::bag
