#include "stillpoint/runtime/plugin_library.hpp"

#define BOOST_DLL_USE_STD_FS
#include <boost/dll/shared_library.hpp>
#include <deque>

#include "stillpoint/runtime/plugin_stamp.hpp"

namespace stillpoint {
namespace {

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

PluginLibrary load_plugin_library(const std::filesystem::path& file) {
  PluginLibrary result;
  result.reason = why_library_does_not_fit(file);
  if (!result.reason.empty()) return result;
  try {
    namespace mode = boost::dll::load_mode;
    const boost::dll::shared_library library(file, mode::rtld_now | mode::rtld_local);
    result.handle = keep_loaded(library);
    const auto& descriptor = library.get<const PluginDescriptor>(kPluginSymbol);
    if (descriptor.name && descriptor.version && descriptor.entries)
      result.descriptor = &descriptor;
    else
      result.reason = "its descriptor is incomplete";
  } catch (const std::exception& error) {
    result.reason = loader_message(error.what(), file.string());
  }
  return result;
}

}  // namespace stillpoint
