// What is fuzzed: a parser of files that others wrote.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

namespace stillpoint::testing {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

struct FuzzTarget {
  std::vector<Bytes> seeds;  ///< valid files, small
  /// Parses a file. It may throw a std::runtime_error, as Error is; anything else is a fault.
  std::function<void(const std::filesystem::path& file)> parse;
  /// After a mutation: checksums, without which nothing behind them would be reached.
  std::function<void(Bytes&)> repair = [](Bytes&) {};
  std::vector<std::string> words = {};  ///< that the format knows, for mutations
};

struct NamedFuzzTarget {
  const char* name;
  FuzzTarget (*make)();
};

// A kind of input each, in the file of that name.
std::vector<NamedFuzzTarget> bag_targets();
std::vector<NamedFuzzTarget> configuration_targets();
std::vector<NamedFuzzTarget> folder_targets();
std::vector<NamedFuzzTarget> image_targets();
std::vector<NamedFuzzTarget> live_view_targets();
std::vector<NamedFuzzTarget> map_targets();
std::vector<NamedFuzzTarget> network_targets();
std::vector<NamedFuzzTarget> recording_targets();

inline Bytes bytes_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}
inline Bytes bytes_of_text(std::string_view text) { return {text.begin(), text.end()}; }

}  // namespace stillpoint::testing
