// Finds plugin libraries, checks them before any of their code is used, and makes their stages.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "stillpoint/plugin.hpp"

namespace stillpoint {

/// One implementation that a pipeline file can name.
struct PluginType {
  std::string kind;               ///< of the contract: "tracker", "output", …
  std::string type;               ///< as written after `type:`
  std::string summary;            ///< one line
  std::string plugin;             ///< name of the plugin that provides it
  std::string version;            ///< of that plugin
  std::filesystem::path library;  ///< empty: linked into the program
  const PluginEntry* entry = nullptr;
  std::shared_ptr<const void> handle;  ///< keeps the library loaded
};

/// A library that was found and cannot be used, or cannot provide one of its types.
struct UnusableLibrary {
  std::filesystem::path library;
  std::string reason;
};

/// The first library found with a (kind, type) provides it; the other types of later ones can be
/// used. A library that fails a check is listed with its reason and the others still load. Loaded
/// libraries stay in memory until the process ends, also after the registry is gone: exceptions and
/// shared objects point into their code.
class STILLPOINT_EXPORT Registry {
 public:
  /// Stages linked into the program, for tests. The descriptor must outlive every object.
  void add(const PluginDescriptor& descriptor);
  /// Loads every libstillpoint_*.so of a folder; one that does not exist is among
  /// missing_folders().
  void search(const std::filesystem::path& folder);
  /// Loads one library, of whatever name.
  void load(const std::filesystem::path& library);

  const std::vector<PluginType>& types() const { return types_; }
  const std::vector<UnusableLibrary>& unusable() const { return unusable_; }
  const std::vector<std::filesystem::path>& searched() const { return searched_; }
  std::vector<std::filesystem::path> missing_folders() const;

  /// Null when there is none.
  const PluginType* find(std::string_view kind, std::string_view type) const;
  /// Several lines for a type that is not there: the nearest name, what is available, what is not
  /// usable and why, where it was looked for.
  std::string explain_missing(std::string_view kind, std::string_view type) const;

 private:
  void add(const PluginDescriptor& descriptor, const std::filesystem::path& file,
           std::shared_ptr<const void> handle);

  std::vector<PluginType> types_;
  std::vector<UnusableLibrary> unusable_;
  std::vector<std::filesystem::path> searched_;
};

/// Visits the default options of a type. Throws what the type's visit() throws.
STILLPOINT_EXPORT void describe_options(const PluginType& type, OptionVisitor& visitor);

/// Use create().
STILLPOINT_EXPORT std::shared_ptr<void> create_object(const PluginType& type, std::string_view kind,
                                                      OptionVisitor& options,
                                                      const StageContext& context,
                                                      void (*destroy)(void*));

/// Makes an object of `Interface` with the options that the visitor writes into it. The object
/// keeps its library. An exception of the constructor leaves as Error in words that name the type:
/// with the fault of an Error, kStage otherwise.
template <class Interface>
std::shared_ptr<Interface> create(const PluginType& type, OptionVisitor& options,
                                  const StageContext& context) {
  return std::static_pointer_cast<Interface>(
      create_object(type, Interface::kKind, options, context,
                    [](void* object) { delete static_cast<Interface*>(object); }));
}

}  // namespace stillpoint
