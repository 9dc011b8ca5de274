#include "bag/joined_bag.hpp"

#include <utility>

namespace stillpoint::bag {

JoinedBag::JoinedBag(std::vector<std::unique_ptr<BagReader>> bags, DamageList unreadable)
    : bags_(std::move(bags)) {
  damage_ = std::move(unreadable);
  for (std::uint32_t file = 0; file < bags_.size(); ++file) {
    std::vector<std::uint32_t> joined;  // index of each topic of the file
    for (const Topic& topic : bags_[file]->topics()) joined.push_back(add_topic(topic));
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
  std::vector<std::string> all = damage_.texts();
  for (const auto& bag : bags_)
    for (std::string& text : bag->damage()) all.push_back(std::move(text));
  return all;
}

ByteSpan JoinedBag::read(const MessagePlace& place, std::size_t at_most) {
  return bags_[place.file]->read(place, at_most);
}

}  // namespace stillpoint::bag
