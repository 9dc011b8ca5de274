#include "bag/joined_bag.hpp"

#include <algorithm>

namespace stillpoint::bag {

JoinedBag::JoinedBag(std::vector<std::unique_ptr<BagReader>> bags) : bags_(std::move(bags)) {
  for (std::uint32_t file = 0; file < bags_.size(); ++file) {
    std::vector<std::uint32_t> joined;  // index of each topic of the file
    for (const Topic& topic : bags_[file]->topics()) {
      const auto same = [&](const Topic& other) {
        return other.name == topic.name && other.type == topic.type &&
               other.encoding == topic.encoding;
      };
      const auto known = std::find_if(topics_.begin(), topics_.end(), same);
      joined.push_back(static_cast<std::uint32_t>(known - topics_.begin()));
      if (known == topics_.end()) topics_.push_back(topic);
    }
    for (MessagePlace place : bags_[file]->messages()) {
      place.topic = joined[place.topic];
      place.file = file;
      messages_.push_back(place);
    }
  }
  sort_messages();
}

std::string JoinedBag::format() const {
  return bags_.front()->format() + ", " + std::to_string(bags_.size()) + " files";
}

std::vector<std::string> JoinedBag::damage() const {
  std::vector<std::string> all;
  for (const auto& bag : bags_)
    for (std::string& text : bag->damage()) all.push_back(std::move(text));
  return all;
}

ByteSpan JoinedBag::read(const MessagePlace& place, std::size_t at_most) {
  return bags_[place.file]->read(place, at_most);
}

}  // namespace stillpoint::bag
