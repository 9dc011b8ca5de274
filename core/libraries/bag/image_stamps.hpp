// When the images of a topic were taken.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bag/bag_reader.hpp"
#include "bag/topic_choice.hpp"

namespace stillpoint::bag {

struct ImageStamp {
  double time = 0.0;  ///< seconds, of the exposure as the driver says; without that, of arrival
  MessagePlace place;
};

struct ImageStamps {
  std::vector<ImageStamp> images;  ///< strictly in order of time
  std::size_t unreadable = 0;      ///< messages that are damaged
  std::size_t repeated = 0;        ///< left out for a stamp that another one has
  std::size_t steps_back = 0;      ///< of more than a second, from one image to the next to arrive
  double largest_step_back = 0.0;  ///< seconds

  /// What was left out or put in another order, a line each; `topic` begins it.
  std::vector<std::string> warnings(const std::string& topic) const;
};

/// Reads the beginning of every message of the topics, each of which is decompressed for that:
/// colour and depth at once, because they share chunks.
std::vector<ImageStamps> image_stamps(BagReader& bag, const std::vector<ImageTopic>& topics);

}  // namespace stillpoint::bag
