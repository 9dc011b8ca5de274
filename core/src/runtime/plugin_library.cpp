#include "stillpoint/runtime/plugin_library.hpp"

#include <dlfcn.h>

#define BOOST_DLL_USE_STD_FS
#include <boost/dll/shared_library.hpp>
#include <deque>
#include <mutex>
#include <system_error>

#include "../loader_message.hpp"
#include "stillpoint/engine/stage_guard.hpp"
#include "stillpoint/error.hpp"
#include "stillpoint/runtime/plugin_stamp.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;

/// Runs the library's static constructors; empty with a reason when it cannot be loaded.
boost::dll::shared_library load(const fs::path& file, std::string& reason) {
  boost::dll::shared_library library;
  auto open = [&] {
    namespace mode = boost::dll::load_mode;
    std::error_code error;
    library.load(file, mode::rtld_now | mode::rtld_local, error);
    if (error) reason = "cannot be loaded: " + loader_message(file.string());
  };
  const std::string name = "loading " + file.string();
  try {
    call_guarded(name, std::nullopt, open);
  } catch (const std::exception& error) {  // dlopen() still holds its lock
    throw Error(Fault::kStage, error.what(), name,
                "its static constructors did that; fix the plugin, or remove it from the folder");
  } catch (...) {
    throw Error(Fault::kStage, "it threw something that is not a std::exception", name,
                "its static constructors did that; fix the plugin, or remove it from the folder");
  }
  if (reason.empty()) StageGuard::library_was_loaded(::dlsym(library.native(), kPluginSymbol));
  return library;
}

/// Holds libraries until the process ends: exceptions, control blocks and registered prototypes
/// point into their code, also while static objects are destroyed.
std::shared_ptr<const void> keep_loaded(const boost::dll::shared_library& library) {
  static std::mutex mutex;
  static auto& libraries = *new std::deque<boost::dll::shared_library>;
  const std::lock_guard lock(mutex);
  libraries.push_back(library);
  return std::make_shared<const boost::dll::shared_library>(library);
}

}  // namespace

PluginLibrary load_plugin_library(const fs::path& file) {
  PluginLibrary result;
  result.reason = why_library_does_not_fit(file);
  if (!result.reason.empty()) return result;
  const boost::dll::shared_library library = load(file, result.reason);
  if (!result.reason.empty()) return result;
  result.handle = keep_loaded(library);
  if (!library.has(kPluginSymbol)) {
    result.reason = std::string("does not export '") + kPluginSymbol + "'";
    return result;
  }
  const auto& descriptor = library.get<const PluginDescriptor>(kPluginSymbol);
  if (descriptor.name && descriptor.version && descriptor.entries)
    result.descriptor = &descriptor;
  else
    result.reason = "its descriptor is incomplete";
  return result;
}

}  // namespace stillpoint
