// Writes small bags in the three formats; for tests of what reads them.
#pragma once

#include <filesystem>
#include <memory>

#include "support/bag_messages.hpp"
#include "support/mcap_bag_writer.hpp"
#include "support/ros1_bag_writer.hpp"
#include "support/ros2_database_writer.hpp"

namespace stillpoint::testing {

inline std::unique_ptr<BagWriter> make_bag_writer(const std::filesystem::path& file,
                                                  const BagStyle& style) {
  if (style.format == "bag") return std::make_unique<Ros1BagWriter>(file, style);
  if (style.format == "mcap") return std::make_unique<McapBagWriter>(file, style);
  return std::make_unique<Ros2DatabaseWriter>(file, style);
}

}  // namespace stillpoint::testing
