// What is damaged in a file, for people.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace stillpoint::bag {

/// The first of many, and how many there are.
class DamageList {
 public:
  void add(std::string text) {
    if (++count_ <= kListed) texts_.push_back(std::move(text));
  }

  bool empty() const { return count_ == 0; }
  std::vector<std::string> texts() const {
    std::vector<std::string> texts = texts_;
    if (count_ > kListed)
      texts.push_back("and " + std::to_string(count_ - kListed) + " faults more");
    return texts;
  }

 private:
  static constexpr std::size_t kListed = 10;
  std::size_t count_ = 0;
  std::vector<std::string> texts_;
};

}  // namespace stillpoint::bag
