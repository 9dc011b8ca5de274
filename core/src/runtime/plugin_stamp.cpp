#include "stillpoint/runtime/plugin_stamp.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "stillpoint/runtime/elf_file.hpp"
#include "stillpoint/support/contract_list.hpp"

namespace stillpoint {
namespace {

constexpr const char* kRebuild = "; rebuild it against Stillpoint " STILLPOINT_VERSION;

struct Stamp {
  std::uint32_t api = 0;
  std::string abi;
  std::vector<std::pair<std::string, std::uint32_t>> kinds;
};

std::uint32_t number(const std::string& text) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size())
    throw UnusableFile("its stamp is damaged");
  return value;
}

Stamp parse(const std::string& bytes) {
  std::istringstream lines(bytes.substr(0, bytes.find('\0')));
  std::string key, value;
  if (!(lines >> key >> value) || key != "stillpoint" || value != "plugin")
    throw UnusableFile("its stamp is damaged");
  Stamp stamp;
  while (lines >> key >> value) {
    if (key == "api")
      stamp.api = number(value);
    else if (key == "abi")
      stamp.abi = value;
    else
      stamp.kinds.emplace_back(key, number(value));
  }
  return stamp;
}

Stamp read_stamp(const std::filesystem::path& file) {
  if (const auto bytes = exported_object(file, kPluginStampSymbol)) return parse(*bytes);
  if (exported_object(file, kPluginSymbol))
    throw UnusableFile("built for a plugin API before 10, this program has API " +
                       std::to_string(kPluginApi) + kRebuild);
  throw UnusableFile("does not export '" + std::string(kPluginSymbol) +
                     "'; a plugin needs STILLPOINT_PLUGIN(…) once");
}

std::string why_stamp_does_not_fit(const Stamp& stamp) {
  if (stamp.api != kPluginApi)
    return "built for plugin API " + std::to_string(stamp.api) + ", this program has API " +
           std::to_string(kPluginApi) + kRebuild;
  if (stamp.abi != kAbiTag)
    return "built with " + (stamp.abi.empty() ? "nothing known" : stamp.abi) +
           ", this program with " + kAbiTag +
           "; rebuild it with the same standard library, Eigen, OpenCV and processor flags";
  std::string reason;
  for (const auto& [kind, api] : stamp.kinds) {
    reason = why_kind_does_not_fit(kind, api);
    if (reason.empty()) return {};  // the others are refused one by one
  }
  return reason;
}

}  // namespace

std::string why_library_does_not_fit(const std::filesystem::path& file) {
  try {
    return why_stamp_does_not_fit(read_stamp(file));
  } catch (const UnusableFile& fault) {
    return fault.what();
  }
}

std::string why_kind_does_not_fit(std::string_view kind, std::uint32_t kind_api) {
  const auto known = std::ranges::find(Contracts::kKinds, kind, &KindApi::kind);
  if (known == Contracts::kKinds.end()) return "there is no kind '" + std::string(kind) + "'";
  if (known->api == kind_api) return {};
  return "built for API " + std::to_string(kind_api) + " of kind '" + std::string(kind) +
         "', this program has API " + std::to_string(known->api) + kRebuild;
}

}  // namespace stillpoint
