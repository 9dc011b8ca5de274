#include "bag/bag_reader.hpp"

#include <algorithm>
#include <utility>

#include "bag/file_reader.hpp"
#include "bag/joined_bag.hpp"
#include "bag/mcap_file.hpp"
#include "bag/ros1_bag.hpp"
#include "bag/ros2_database.hpp"
#include "stillpoint/support/bag_files.hpp"

namespace stillpoint::bag {
namespace {

namespace fs = std::filesystem;

std::unique_ptr<BagReader> open_file(const fs::path& path) {
  std::string begin;
  {
    FileReader file(path);
    const ByteSpan bytes = file.bytes(0, 16);
    begin.assign(bytes.begin(), bytes.end());
  }
  if (begin.starts_with(kRos1Magic)) return std::make_unique<Ros1Bag>(path);
  if (begin.starts_with(kMcapMagic)) return std::make_unique<McapFile>(path);
  if (begin.starts_with("SQLite format 3")) return std::make_unique<Ros2Database>(path);
  if (begin.starts_with("#ROSBAG V1"))
    throw Error(Fault::kData, "is a bag of the old version 1", path.string(),
                "convert it with 'rosbag fix' of ROS 1");
  if (is_zstd({reinterpret_cast<const std::uint8_t*>(begin.data()), begin.size()}))
    throw Error(Fault::kData, "is compressed as a whole", path.string(),
                "decompress it with 'zstd -d' first");
  throw Error(Fault::kData, begin.empty() ? "is empty" : "is neither a ROS 1 bag, MCAP nor SQLite",
              path.string());
}

}  // namespace

std::uint32_t BagReader::add_topic(Topic topic) {
  const auto same = [&](const Topic& other) {
    return other.name == topic.name && other.type == topic.type && other.encoding == topic.encoding;
  };
  const auto known = std::find_if(topics_.begin(), topics_.end(), same);
  const auto index = static_cast<std::uint32_t>(known - topics_.begin());
  if (known == topics_.end()) topics_.push_back(std::move(topic));
  return index;
}

void BagReader::sort_messages() { std::ranges::stable_sort(messages_, {}, &MessagePlace::time); }

std::unique_ptr<BagReader> open_bag(const fs::path& named) {
  const fs::path path = bag_path(named);
  std::error_code error;
  if (!fs::is_directory(path, error)) return open_file(path);
  const std::vector<fs::path> files = bag_files(path);
  if (files.empty())
    throw Error(Fault::kData, "holds no bag", path.string(),
                "expected files that end in .bag, .mcap or .db3");
  if (files.size() == 1) return open_file(files.front());
  std::vector<std::unique_ptr<BagReader>> bags;
  DamageList unreadable;
  for (const fs::path& file : files) {
    try {
      bags.push_back(open_file(file));
    } catch (const Error& fault) {  // the last one of a recorder that was killed may be empty
      unreadable.add(fault.what());
    }
  }
  if (bags.empty())
    throw Error(Fault::kData, "none of its bags can be read; first: " + unreadable.texts().front(),
                path.string());
  return std::make_unique<JoinedBag>(std::move(bags), std::move(unreadable));
}

std::string ros1_type(std::string type) {
  constexpr std::string_view kMessage = "/msg/";
  const auto at = type.find(kMessage);
  return at == std::string::npos ? type : type.replace(at, kMessage.size(), "/");
}

}  // namespace stillpoint::bag
