// What is fuzzed: a parser of files that others wrote.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace stillpoint::testing {

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
std::vector<NamedFuzzTarget> fuzz_targets();

}  // namespace stillpoint::testing
