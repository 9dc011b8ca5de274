#include "semantic_octree/octree_reader.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "stillpoint/error.hpp"

namespace stillpoint::semantic_octree {
namespace {

constexpr unsigned kTreeDepth = 16;
constexpr unsigned kLeastDepth = 7;             // of a leaf: it stands for 512³ voxels
constexpr std::size_t kMostOccupied = 1 << 28;  // voxels
// A node with its place in its parent's list, and what the allocator adds to both.
constexpr std::size_t kNodeBytes = sizeof(SemanticVoxel) + sizeof(void*) + 24;
constexpr double kMinResolution = 1e-3, kMaxResolution = 10;  // metres

/// What is left of a file.
class Bytes {
 public:
  Bytes(std::string_view rest, std::string where) : rest_(rest), where_(std::move(where)) {}

  [[noreturn]] void fail(const std::string& problem) const {
    throw Error(Fault::kData, problem, where_);
  }
  bool empty() const { return rest_.empty(); }
  std::string_view take(std::size_t count) {
    if (rest_.size() < count) fail("the file ends within the map");
    const std::string_view taken = rest_.substr(0, count);
    rest_.remove_prefix(count);
    return taken;
  }
  template <class T>
  T take() {
    T value;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
  std::string_view line() {
    const std::size_t end = rest_.find('\n');
    if (end == std::string_view::npos) fail("the file ends within its header");
    const std::string_view text = take(end + 1);
    return text.substr(0, end);
  }
  bool skip(std::string_view text) {
    if (!rest_.starts_with(text)) return false;
    rest_.remove_prefix(text.size());
    return true;
  }

 private:
  std::string_view rest_;
  std::string where_;
};

struct Header {
  bool binary = false;
  std::string_view id;
  double resolution = 0;
  double nodes = -1;
};

double number_from(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? value : 0;
}

Header read_header(Bytes& bytes) {
  Header header;
  if (bytes.skip("# Octomap OcTree binary file"))
    header.binary = true;
  else if (!bytes.skip("# Octomap OcTree file"))
    bytes.fail("is no octree of OctoMap (.ot or .bt)");
  for (std::string_view line = bytes.line(); line != "data"; line = bytes.line()) {
    if (line.starts_with("id ")) header.id = line.substr(3);
    if (line.starts_with("size ")) header.nodes = number_from(line.substr(5));
    if (line.starts_with("res ")) header.resolution = number_from(line.substr(4));
  }
  if (!(header.resolution >= kMinResolution && header.resolution <= kMaxResolution))
    bytes.fail("has no resolution from 1 mm to 10 m in its header");
  if (header.id != "OcTree" && header.id != "ColorOcTree")
    bytes.fail("is a tree of type '" + std::string(header.id) +
               "'; OcTree and ColorOcTree are known");
  return header;
}

/// Makes nodes until they take too much memory: two bytes of a file can ask for eight.
class NodeMaker {
 public:
  NodeMaker(SemanticOctree& tree, const Bytes& bytes, std::size_t most_memory)
      : tree_(tree), bytes_(bytes), most_nodes_(most_memory / kNodeBytes) {}

  SemanticVoxel& make(SemanticVoxel& parent, unsigned place) {
    if (tree_.size() >= most_nodes_)
      bytes_.fail("has more than " + std::to_string(most_nodes_) + " nodes, too many for memory");
    return *tree_.createNodeChild(&parent, place);
  }

 private:
  SemanticOctree& tree_;
  const Bytes& bytes_;
  std::size_t most_nodes_;
};

/// The nodes of an .ot file: log-odds, colour, which children there are; then those.
class NodeReader {
 public:
  NodeReader(NodeMaker maker, Bytes& bytes, bool colors)
      : maker_(maker), bytes_(bytes), colors_(colors) {}

  void read(SemanticVoxel& node, unsigned depth) {
    const auto log_odds = bytes_.take<float>();
    if (!std::isfinite(log_odds)) bytes_.fail("is damaged: a voxel without occupancy");
    node.setLogOdds(log_odds);
    if (colors_) {
      const auto rgb = bytes_.take<std::array<std::uint8_t, 3>>();
      node.setColor(rgb[0], rgb[1], rgb[2]);
    }
    const auto children = bytes_.take<std::uint8_t>();
    if (children != 0 && depth == kTreeDepth) bytes_.fail("is damaged: a voxel has parts");
    for (unsigned i = 0; i < 8; ++i)
      if (children >> i & 1U) read(maker_.make(node, i), depth + 1);
  }

 private:
  NodeMaker maker_;
  Bytes& bytes_;
  bool colors_;
};

/// The nodes of a .bt file: two bits for each child.
class BinaryNodeReader {
 public:
  BinaryNodeReader(SemanticOctree& tree, NodeMaker maker, Bytes& bytes)
      : tree_(tree), maker_(maker), bytes_(bytes) {}

  void read(SemanticVoxel& node, unsigned depth) {
    if (depth == kTreeDepth) bytes_.fail("is damaged: a voxel has parts");
    enum Kind : unsigned { kUnknown, kFree, kOccupied, kInner };
    const auto kinds = bytes_.take<std::uint16_t>();
    for (unsigned i = 0; i < 8; ++i) {
      const unsigned kind = kinds >> (2 * i) & 3U;
      if (kind == kUnknown) continue;
      SemanticVoxel& child = maker_.make(node, i);
      child.setLogOdds(kind == kFree ? tree_.getClampingThresMinLog()
                                     : tree_.getClampingThresMaxLog());
    }
    for (unsigned i = 0; i < 8; ++i)
      if ((kinds >> (2 * i) & 3U) == kInner) read(*tree_.getNodeChild(&node, i), depth + 1);
    if (tree_.nodeHasChildren(&node)) node.summarise_children();
  }

 private:
  SemanticOctree& tree_;
  NodeMaker maker_;
  Bytes& bytes_;
};

MapClasses read_classes(SemanticOctree& tree, Bytes& bytes) {
  if (bytes.line() != "1") bytes.fail("its classes were written by a newer version");
  MapClasses classes;
  try {
    const auto description = nlohmann::json::parse(bytes.line());
    description.at("names").get_to(classes.names);
    description.at("colors").get_to(classes.colors);
    const auto threshold = description.value("occupied_above", 0.5);
    if (!(threshold > 0 && threshold < 1)) bytes.fail("is damaged: occupied above no probability");
    tree.setOccupancyThres(threshold);
  } catch (const nlohmann::json::exception&) {
    bytes.fail("is damaged: the names of its classes cannot be read");
  }
  if (classes.names.size() != classes.colors.size())
    bytes.fail("is damaged: its classes have names or colours, not both");
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    const auto label = bytes.take<std::uint8_t>(), confidence = bytes.take<std::uint8_t>();
    if (confidence > 0 && !classes.names.empty() && label >= classes.names.size())
      bytes.fail("is damaged: a voxel of class " + std::to_string(label) + " of " +
                 std::to_string(classes.names.size()));
    leaf->set_classes(ClassBelief::of(label, confidence));
  }
  return classes;
}

// What works on maps goes through all of their voxels.
void check_leaves(SavedOctree& saved, const Bytes& bytes) {
  const SemanticOctree& tree = *saved.tree;
  std::size_t occupied = 0;
  bool colored = false;
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    if (leaf.getDepth() < kLeastDepth) bytes.fail("is damaged: a leaf of 1000 voxels or more");
    if (tree.isNodeOccupied(*leaf))
      occupied += std::size_t{1} << (3 * (kTreeDepth - leaf.getDepth()));
    colored |= leaf->isColorSet();
  }
  if (occupied > kMostOccupied) bytes.fail("has too many occupied voxels");
  saved.has_colors &= colored;
}

// A pipe would be waited for, and a device never ends.
std::string contents_of(const std::filesystem::path& file, std::size_t most_memory) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) throw Error(Fault::kData, "cannot be read", file.string());
  if (size > most_memory)
    throw Error(Fault::kData, "is too large: " + std::to_string(size) + " bytes", file.string());
  std::ifstream stream(file, std::ios::binary);
  std::string contents(size, '\0');
  stream.read(contents.data(), static_cast<std::streamsize>(size));
  if (!stream) throw Error(Fault::kData, "cannot be read", file.string());
  return contents;
}

}  // namespace

SavedOctree read_octree(const std::filesystem::path& file, std::size_t most_memory) {
  const std::string contents = contents_of(file, most_memory);
  Bytes bytes(contents, file.string());
  const Header header = read_header(bytes);
  SavedOctree saved{.tree = std::make_unique<SemanticOctree>(header.resolution),
                    .classes = {},
                    .has_colors = !header.binary && header.id == "ColorOcTree"};
  if (header.nodes == 0) bytes.fail("holds no voxel");
  SemanticVoxel& root = saved.tree->create_root();
  const NodeMaker maker(*saved.tree, bytes, most_memory);
  if (header.binary)
    BinaryNodeReader(*saved.tree, maker, bytes).read(root, 0);
  else
    NodeReader(maker, bytes, saved.has_colors).read(root, 0);
  if (static_cast<double>(saved.tree->size()) != header.nodes)
    bytes.fail("is damaged: it holds " + std::to_string(saved.tree->size()) + " nodes");
  if (bytes.skip("# stillpoint classes ")) saved.classes = read_classes(*saved.tree, bytes);
  if (!bytes.empty()) bytes.fail("is damaged: more follows the map");
  check_leaves(saved, bytes);
  return saved;
}

}  // namespace stillpoint::semantic_octree
