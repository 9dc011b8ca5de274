// How a library tells what it provides: one constant descriptor behind one exported symbol. No code
// of the plugin runs before its API number and ABI tag have been compared.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <opencv2/core/version.hpp>
#include <optional>
#include <string_view>
#include <type_traits>

#include "stillpoint/class_names.hpp"
#include "stillpoint/contracts/camera.hpp"
#include "stillpoint/export.hpp"
#include "stillpoint/options.hpp"

namespace stillpoint {

/// Goes up with any change under contracts/, in plugin.hpp or in options.hpp.
inline constexpr std::uint32_t kPluginApi = 9;

#define STILLPOINT_TEXT_(x) #x
#define STILLPOINT_TEXT(x) STILLPOINT_TEXT_(x)

/// What must be equal for C++ objects to cross the border: compiler, language, standard library,
/// Eigen with its alignment (it changes with -mavx), OpenCV.
inline constexpr const char* kAbiTag =
    "gcc" STILLPOINT_TEXT(__GNUC__) "-c++" STILLPOINT_TEXT(__cplusplus) "-cxx11abi"
    STILLPOINT_TEXT(_GLIBCXX_USE_CXX11_ABI) "-eigen" STILLPOINT_TEXT(EIGEN_WORLD_VERSION) "."
    STILLPOINT_TEXT(EIGEN_MAJOR_VERSION) "." STILLPOINT_TEXT(EIGEN_MINOR_VERSION) "-align"
    STILLPOINT_TEXT(EIGEN_MAX_ALIGN_BYTES) "-opencv" STILLPOINT_TEXT(CV_VERSION_MAJOR) "."
    STILLPOINT_TEXT(CV_VERSION_MINOR);

enum class LogLevel { kDebug, kInfo, kWarning, kError };

/// What the program tells a stage besides its options.
struct StageContext {
  std::uint64_t seed = 1;                  ///< of this stage alone
  int threads = 1;                         ///< that its solvers may use
  bool deterministic = true;               ///< `mode: inline`: no clock and no races in decisions
  std::filesystem::path output_directory;  ///< of the run; exists when outputs are created
  std::filesystem::path recording;         ///< what the source reads; empty when it reads none
  std::optional<CameraModel> camera;       ///< the `camera:` section, of the source
  ClassNames classes;                      ///< of the segmenter; empty without one
  std::function<void(LogLevel, std::string_view)> log = [](LogLevel, std::string_view) {};
};

/// One implementation of one contract.
struct PluginEntry {
  const char* kind;                  ///< of the contract, as Interface::kKind
  const char* type;                  ///< what a pipeline file writes after `type:`
  const char* summary;               ///< one line
  void (*describe)(OptionVisitor&);  ///< visits default options
  void* (*create)(OptionVisitor&, const StageContext&);  ///< returns an Interface*
};

struct PluginDescriptor {
  std::uint32_t api_version;
  const char* abi_tag;
  const char* name;
  const char* version;
  const PluginEntry* entries;
  std::size_t entry_count;
};

inline constexpr const char* kPluginSymbol = "stillpoint_plugin";

namespace detail {

struct NoOptions {
  void visit(OptionVisitor&) {}
};

template <class T>
struct OptionsOf {
  using type = NoOptions;
};
template <class T>
requires requires { typename T::Options; }
struct OptionsOf<T> {
  using type = typename T::Options;
};

template <class Implementation>
void describe(OptionVisitor& visitor) {
  typename OptionsOf<Implementation>::type options;
  options.visit(visitor);
}

template <class Interface, class Implementation>
void* create(OptionVisitor& visitor, const StageContext& context) {
  using Options = typename OptionsOf<Implementation>::type;
  Options options;
  options.visit(visitor);
  Interface* object = nullptr;
  if constexpr (std::is_constructible_v<Implementation, Options, const StageContext&>)
    object = new Implementation(options, context);
  else if constexpr (std::is_constructible_v<Implementation, Options>)
    object = new Implementation(options);
  else
    object = new Implementation();
  return object;
}

}  // namespace detail

/// An entry for a class with a constructor from (Options, const StageContext&), (Options) or ().
template <class Interface, class Implementation>
constexpr PluginEntry provide(const char* type, const char* summary) {
  static_assert(std::is_base_of_v<Interface, Implementation>);
  using Options = typename detail::OptionsOf<Implementation>::type;
  static_assert(std::is_same_v<Options, detail::NoOptions> ||
                    std::is_constructible_v<Implementation, Options, const StageContext&> ||
                    std::is_constructible_v<Implementation, Options>,
                "a class with Options needs a constructor that takes them, (Options) or (Options, "
                "const StageContext&): what users write in the pipeline file would be lost");
  return {Interface::kKind, type, summary, &detail::describe<Implementation>,
          &detail::create<Interface, Implementation>};
}

}  // namespace stillpoint

/// Once per library, at namespace scope: STILLPOINT_PLUGIN(name, "version", provide<…>(…), …);
#define STILLPOINT_PLUGIN(plugin_name, plugin_version, ...)                          \
  namespace {                                                                        \
  constexpr stillpoint::PluginEntry stillpoint_entries[] = {__VA_ARGS__};            \
  }                                                                                  \
  extern "C" STILLPOINT_EXPORT const stillpoint::PluginDescriptor stillpoint_plugin; \
  const stillpoint::PluginDescriptor stillpoint_plugin = {                           \
      stillpoint::kPluginApi, stillpoint::kAbiTag,                                   \
      #plugin_name,           plugin_version,                                        \
      stillpoint_entries,     sizeof(stillpoint_entries) / sizeof(stillpoint_entries[0])}
