#include "stillpoint/runtime/plugin_library.hpp"

#define BOOST_DLL_USE_STD_FS
#include <algorithm>
#include <boost/dll/shared_library.hpp>
#include <deque>

#include "stillpoint/runtime/elf_file.hpp"
#include "stillpoint/sdk.hpp"

namespace stillpoint {
namespace {

constexpr const char* kKinds[] = {Source::kKind,        Segmenter::kKind,   Propagator::kKind,
                                  MovingChecker::kKind, MapChecker::kKind,  Decision::kKind,
                                  Tracker::kKind,       LocalMapper::kKind, LoopCloser::kKind,
                                  MapBackend::kKind,    Output::kKind};

std::string check_entry(const PluginEntry& entry) {
  if (!entry.kind || !entry.type || !entry.summary || !entry.describe || !entry.create)
    return "its descriptor has an incomplete entry";
  const auto same = [&](const char* kind) { return std::string_view(kind) == entry.kind; };
  if (std::ranges::none_of(kKinds, same))
    return "provides '" + std::string(entry.type) + "' of unknown kind '" + entry.kind + "'";
  return {};
}

/// What dlopen said: Boost writes "… (dlerror system message: PATH: TEXT): ERRNO", where errno is
/// not dlopen's and the path is known to the reader.
std::string loader_message(std::string text, const std::string& file) {
  const std::string before = file + ": ";
  const auto start = text.find(before);
  const auto end = text.rfind("): ");
  if (start != std::string::npos && end != std::string::npos && end > start)
    text = text.substr(start + before.size(), end - start - before.size());
  return "cannot be loaded: " + text;
}

/// Holds libraries until the process ends: exceptions, control blocks and registered prototypes
/// point into their code, also while static objects are destroyed.
std::shared_ptr<const void> keep_loaded(const boost::dll::shared_library& library) {
  static auto& libraries = *new std::deque<boost::dll::shared_library>;
  libraries.push_back(library);
  return std::make_shared<const boost::dll::shared_library>(library);
}

}  // namespace

std::string check_descriptor(const PluginDescriptor& descriptor) {
  // Only the first two members are where they are in every API.
  if (descriptor.api_version != kPluginApi)
    return "built for plugin API " + std::to_string(descriptor.api_version) +
           ", this program has API " + std::to_string(kPluginApi) +
           "; rebuild it against Stillpoint " STILLPOINT_VERSION;
  if (!descriptor.abi_tag || std::string_view(descriptor.abi_tag) != kAbiTag)
    return "built with " + std::string(descriptor.abi_tag ? descriptor.abi_tag : "nothing known") +
           ", this program with " + kAbiTag +
           "; rebuild it with the same compiler, Eigen, OpenCV and processor flags";
  if (!descriptor.name || !descriptor.version || !descriptor.entries)
    return "its descriptor is incomplete";
  for (std::size_t i = 0; i < descriptor.entry_count; ++i)
    if (std::string fault = check_entry(descriptor.entries[i]); !fault.empty()) return fault;
  return {};
}

PluginLibrary load_plugin_library(const std::filesystem::path& file) {
  PluginLibrary result;
  result.reason = why_not_exporting(file, kPluginSymbol);
  if (!result.reason.empty()) return result;
  try {
    namespace mode = boost::dll::load_mode;
    const boost::dll::shared_library library(file, mode::rtld_now | mode::rtld_local);
    result.handle = keep_loaded(library);
    const auto& descriptor = library.get<const PluginDescriptor>(kPluginSymbol);
    result.reason = check_descriptor(descriptor);
    if (result.reason.empty()) result.descriptor = &descriptor;
  } catch (const std::exception& error) {
    result.reason = loader_message(error.what(), file.string());
  }
  return result;
}

}  // namespace stillpoint
