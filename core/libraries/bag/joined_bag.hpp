// Several files of one recording, as one bag.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bag/bag_reader.hpp"

namespace stillpoint::bag {

class JoinedBag final : public BagReader {
 public:
  /// `unreadable`: those of the recording that are left out.
  JoinedBag(std::vector<std::unique_ptr<BagReader>> bags, DamageList unreadable);

  std::string format() const override;
  std::vector<std::string> damage() const override;
  ByteSpan read(const MessagePlace& place, std::size_t at_most) override;

 private:
  std::vector<std::unique_ptr<BagReader>> bags_;
};

}  // namespace stillpoint::bag
