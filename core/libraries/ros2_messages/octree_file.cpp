#include "ros2_messages/octree_file.hpp"

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "stillpoint/error.hpp"

namespace stillpoint::ros2_messages {

std::optional<Octree> read_octree_message(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "map.bt";
  if (folder.empty() || !std::filesystem::is_regular_file(file)) return std::nullopt;
  std::ifstream in(file, std::ios::binary);
  Octree octree;
  std::string line;
  while (std::getline(in, line) && line != "data")
    if (line.starts_with("res ")) octree.resolution = std::strtod(line.c_str() + 4, nullptr);
  octree.nodes.assign(std::istreambuf_iterator<char>(in), {});
  if (!(octree.resolution > 0) || octree.nodes.empty())
    throw Error(Fault::kData, "is no .bt file of OctoMap", file.string());
  return octree;
}

}  // namespace stillpoint::ros2_messages
