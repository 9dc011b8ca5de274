// A contract that changes without its number going up lets libraries in that do not fit any more.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "stillpoint/sdk.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;

const fs::path kHeaders = fs::path(STILLPOINT_SOURCE_DIR) / "core/include/stillpoint";
// What kPluginApi stands for.
const std::set<std::string> kShared = {
    "plugin.hpp", "options.hpp", "class_names.hpp",     "pose_math.hpp",
    "export.hpp", "error.hpp",   "contracts/frame.hpp", "contracts/camera.hpp"};

/// Without comments and white space, and without the numbers themselves.
std::string code_of(const std::string& header) {
  std::ifstream stream(kHeaders / header);
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  text = std::regex_replace(text, std::regex(R"(//[^\n]*|/\*[^*]*\*/)"), "");
  text = std::regex_replace(text, std::regex(R"((kApi|kPluginApi) = \d+)"), "");
  return std::regex_replace(text, std::regex(R"(\s+)"), "");
}

/// The header and the contracts that it includes, but for what all kinds share.
void collect(const std::string& header, std::set<std::string>& headers) {
  if (kShared.contains(header) || !headers.insert(header).second) return;
  static const std::regex kInclude(R"(#include "stillpoint/(contracts/\w+\.hpp)\")");
  std::ifstream stream(kHeaders / header);
  for (std::string line; std::getline(stream, line);)
    if (std::smatch match; std::regex_match(line, match, kInclude)) collect(match[1], headers);
}

/// FNV-1a of their code.
std::string digest_of(const std::set<std::string>& headers) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const std::string& header : headers)
    for (const char letter : code_of(header))
      hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100000001b3u;
  std::ostringstream text;
  text << std::hex << std::setw(16) << std::setfill('0') << hash;
  return text.str();
}

template <class Interface>
std::string line_of() {
  std::set<std::string> headers;
  collect(std::string("contracts/") + Interface::kKind + ".hpp", headers);
  return std::string(Interface::kKind) + ' ' + std::to_string(Interface::kApi) + ' ' +
         digest_of(headers);
}

TEST(ApiNumbers, GoUpWhenLibrariesHaveToBeBuiltAnew) {
  const std::vector<std::string> now = {
      "shared " + std::to_string(kPluginApi) + ' ' + digest_of(kShared),
      line_of<Source>(),
      line_of<Segmenter>(),
      line_of<Propagator>(),
      line_of<MovingChecker>(),
      line_of<MapChecker>(),
      line_of<Decision>(),
      line_of<Tracker>(),
      line_of<LocalMapper>(),
      line_of<LoopCloser>(),
      line_of<MapBackend>(),
      line_of<Output>()};
  std::vector<std::string> recorded;
  std::ifstream file(STILLPOINT_SOURCE_DIR "/tests/unit/api_numbers.txt");
  for (std::string line; std::getline(file, line);)
    if (!line.starts_with("#")) recorded.push_back(line);
  std::string list;
  for (const std::string& line : now) list += line + '\n';
  EXPECT_EQ(now, recorded)
      << "What the SDK promises has changed. Raise the number of the kind (kApi of the contract, "
         "or "
         "kPluginApi for what all share) if libraries have to be built anew, then write into "
         "tests/unit/api_numbers.txt:\n"
      << list;
}

}  // namespace
}  // namespace stillpoint
