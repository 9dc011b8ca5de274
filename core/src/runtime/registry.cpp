#include "stillpoint/engine/registry.hpp"

#include <algorithm>
#include <span>

#include "stillpoint/engine/stage_guard.hpp"
#include "stillpoint/error.hpp"
#include "stillpoint/runtime/option_describer.hpp"
#include "stillpoint/runtime/plugin_library.hpp"
#include "stillpoint/runtime/plugin_stamp.hpp"
#include "stillpoint/support/did_you_mean.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> plugin_files(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("libstillpoint_") && name.ends_with(".so")) files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

/// Throws Error when a StageGuard had to end it: what it held stays as it was.
void describe(const PluginEntry& entry, const fs::path& library, OptionVisitor& visitor) {
  const std::string name = std::string("the options of ") + entry.kind + " '" + entry.type + "'";
  auto visit = [&] { entry.describe(visitor); };
  try {
    call_guarded(name, std::nullopt, visit);
  } catch (const std::exception& error) {
    if (!StageGuard::has_ended_a_call()) throw;
    throw Error(Fault::kStage, error.what(), library.string() + ": " + name,
                "fix the plugin, or remove it from the folder");
  }
}

/// Nothing can leave a destructor: what ended it is said, and main() gives the exit code. Within a
/// guarded call, that one ends.
void destroy_guarded(const std::string& name, void (*destroy)(void*), void* object,
                     const std::function<void(LogLevel, std::string_view)>& log) {
  if (StageGuard::is_in_call()) return destroy(object);
  try {
    auto call = [&] { destroy(object); };
    call_guarded("the destructor of " + name, std::nullopt, call);
  } catch (const std::exception& error) {
    log(LogLevel::kWarning, "the destructor of " + name + ": " + error.what());
  } catch (...) {
    log(LogLevel::kWarning, "the destructor of " + name + ": it threw no std::exception");
  }
}

/// What is wrong with the options that a plugin declares; empty: nothing.
std::string fault_of_options(const PluginEntry& entry, const fs::path& library) {
  try {
    OptionDescriber describer;
    describe(entry, library, describer);
    return join(describer.faults());
  } catch (const std::exception& error) {
    if (StageGuard::has_ended_a_call()) throw;
    return error.what();
  } catch (...) {
    return "describing them threw something that is not a std::exception";
  }
}

/// Why a type cannot be used; empty when it can.
std::string fault_of(const PluginEntry& entry, const fs::path& library) {
  if (!entry.kind || !entry.type || !entry.summary || !entry.describe || !entry.create)
    return "its descriptor has an incomplete entry";
  const std::string name = std::string(entry.kind) + " '" + entry.type + "'";
  if (const std::string fault = why_kind_does_not_fit(entry.kind, entry.kind_api); !fault.empty())
    return name + ": " + fault;
  const std::string fault = fault_of_options(entry, library);
  return fault.empty() ? fault : "the options of " + name + ": " + fault;
}

}  // namespace

void Registry::add(const PluginDescriptor& descriptor) { add(descriptor, {}, nullptr); }

void Registry::search(const fs::path& folder) {
  const fs::path absolute = fs::absolute(folder).lexically_normal();
  if (std::ranges::find(searched_, absolute) != searched_.end()) return;
  searched_.push_back(absolute);
  for (const fs::path& file : plugin_files(absolute)) load(file);
}

void Registry::load(const fs::path& library_file) {
  const fs::path file =
      fs::absolute(library_file).lexically_normal();  // dlopen() searches for names
  PluginLibrary library = load_plugin_library(file);
  if (library.descriptor)
    add(*library.descriptor, file, std::move(library.handle));
  else
    unusable_.push_back({file, library.reason});
}

void Registry::add(const PluginDescriptor& descriptor, const fs::path& file,
                   std::shared_ptr<const void> handle) {
  const std::span<const PluginEntry> entries(descriptor.entries, descriptor.entry_count);
  for (const PluginEntry& entry : entries) {
    if (const std::string fault = fault_of(entry, file); !fault.empty()) {
      unusable_.push_back({file, fault});
      continue;
    }
    const PluginType* first = find(entry.kind, entry.type);
    if (!first) {
      types_.push_back({entry.kind, entry.type, entry.summary, descriptor.name, descriptor.version,
                        file, &entry, handle});
      continue;
    }
    const std::string provider = first->library.empty() ? "this program" : first->library.string();
    unusable_.push_back({file, std::string(entry.kind) + " '" + entry.type +
                                   "' is already provided by " + provider});
  }
}

std::vector<fs::path> Registry::missing_folders() const {
  std::vector<fs::path> missing;
  std::error_code error;
  for (const fs::path& folder : searched_)
    if (!fs::is_directory(folder, error)) missing.push_back(folder);
  return missing;
}

const PluginType* Registry::find(std::string_view kind, std::string_view type) const {
  const auto found = std::ranges::find_if(types_, [&](const PluginType& candidate) {
    return candidate.kind == kind && candidate.type == type;
  });
  return found == types_.end() ? nullptr : &*found;
}

std::string Registry::explain_missing(std::string_view kind, std::string_view type) const {
  std::vector<std::string> available;
  for (const PluginType& candidate : types_)
    if (candidate.kind == kind) available.push_back(candidate.type);
  std::ranges::sort(available);
  std::string text = "no " + std::string(kind) + " named '" + std::string(type) + "'" +
                     did_you_mean(type, available) +
                     "\n  available:  " + (available.empty() ? "none" : join(available));
  for (const UnusableLibrary& library : unusable_)
    text += "\n  not usable: " + library.library.filename().string() + ": " + library.reason;
  std::vector<std::string> folders;
  std::error_code error;
  for (const fs::path& folder : searched_)
    folders.push_back(folder.string() + (fs::is_directory(folder, error) ? "" : " (not there)"));
  return text + "\n  searched:   " + (folders.empty() ? "nothing" : join(folders)) +
         "      (add folders by 'plugins: {paths: [DIR]}' or STILLPOINT_PLUGIN_PATH)";
}

void describe_options(const PluginType& type, OptionVisitor& visitor) {
  describe(*type.entry, type.library, visitor);
}

std::shared_ptr<void> create_object(const PluginType& type, std::string_view kind,
                                    OptionVisitor& options, const StageContext& context,
                                    void (*destroy)(void*)) {
  const std::string name = type.kind + " (" + type.type + ")";
  if (type.kind != kind) throw Error(Fault::kStage, "asked for as a " + std::string(kind), name);
  try {
    auto create = [&] { return type.entry->create(options, context); };
    void* object = call_guarded("the constructor of " + name, std::nullopt, create);
    return {object, [=, log = context.log, library = type.handle](void* p) {
              destroy_guarded(name, destroy, p, log);
            }};
  } catch (const Error& error) {
    throw Error(error.fault(), error.what(), name);
  } catch (const std::exception& error) {
    throw Error(Fault::kStage, error.what(), name);
  } catch (...) {
    throw Error(Fault::kStage, "threw something that is not a std::exception", name);
  }
}

}  // namespace stillpoint
