// What a plugin library exports: a constant descriptor of its contents, and a stamp that says what
// it was built for. The stamp is read from the file, so no code of an incompatible library runs.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <opencv2/core/version.hpp>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>

#include "stillpoint/class_names.hpp"
#include "stillpoint/contracts/camera.hpp"
#include "stillpoint/export.hpp"
#include "stillpoint/options.hpp"

namespace stillpoint {

/// API version of what all kinds share: this header, options.hpp, frames, cameras and class names.
/// Each contract also has a version of its own, kApi, for its functions, their arguments and their
/// results. A version is raised by every change that requires plugins to be rebuilt
/// (docs/writing_a_plugin.md).
inline constexpr std::uint32_t kPluginApi = 11;

#define STILLPOINT_TEXT_(x) #x
#define STILLPOINT_TEXT(x) STILLPOINT_TEXT_(x)

#ifdef _GLIBCXX_DEBUG
#define STILLPOINT_STD_DEBUG_ "-glibcxxdebug"
#else
#define STILLPOINT_STD_DEBUG_ ""
#endif
#ifdef EIGEN_DEFAULT_TO_ROW_MAJOR
#define STILLPOINT_EIGEN_ORDER_ "-rowmajor"
#else
#define STILLPOINT_EIGEN_ORDER_ ""
#endif

/// What must match so that program and plugin can exchange C++ objects: language, standard library
/// (of the g++ that it came with; clang++ uses the same) and its debug mode, Eigen with its
/// alignment (of memory and of members; -mavx changes both) and storage order, OpenCV.
inline constexpr const char* kAbiTag = "libstdc++" STILLPOINT_TEXT(_GLIBCXX_RELEASE)  //
    "-c++" STILLPOINT_TEXT(__cplusplus)                                               //
    "-cxx11abi" STILLPOINT_TEXT(_GLIBCXX_USE_CXX11_ABI) STILLPOINT_STD_DEBUG_         //
    "-eigen" STILLPOINT_TEXT(EIGEN_WORLD_VERSION) "."                                 //
    STILLPOINT_TEXT(EIGEN_MAJOR_VERSION) "." STILLPOINT_TEXT(EIGEN_MINOR_VERSION)     //
    "-align" STILLPOINT_TEXT(EIGEN_MAX_ALIGN_BYTES) "."                               //
    STILLPOINT_TEXT(EIGEN_MAX_STATIC_ALIGN_BYTES) STILLPOINT_EIGEN_ORDER_             //
    "-opencv" STILLPOINT_TEXT(CV_VERSION_MAJOR) "." STILLPOINT_TEXT(CV_VERSION_MINOR);

enum class LogLevel { kDebug, kInfo, kWarning, kError };

/// What the program tells a stage besides its options. Valid during the constructor: what is needed
/// later is copied. `log` may be called on any thread.
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
  std::uint32_t kind_api;            ///< of the contract, as Interface::kApi
  const char* type;                  ///< what a pipeline file writes after `type:`
  const char* summary;               ///< one line
  void (*describe)(OptionVisitor&);  ///< visits default options
  void* (*create)(OptionVisitor&, const StageContext&);  ///< returns an Interface*
};

struct PluginDescriptor {
  const char* name;
  const char* version;
  const PluginEntry* entries;
  std::size_t entry_count;
};

inline constexpr const char* kPluginSymbol = "stillpoint_plugin";

/// Lines of text, the rest zero: `stillpoint plugin`, `api N`, `abi TAG`, and `KIND N` for each
/// kind provided, N its kind_api.
using PluginStamp = std::array<char, 512>;
inline constexpr const char* kPluginStampSymbol = "stillpoint_plugin_stamp";

namespace detail {

class StampWriter {
 public:
  constexpr void line(std::string_view key, std::string_view value) {
    text(key);
    text(" ");
    text(value);
    text("\n");
  }
  constexpr void line(std::string_view key, std::uint32_t value) {
    std::array<char, 10> digits{};
    std::size_t first = digits.size();
    do digits[--first] = static_cast<char>('0' + value % 10);
    while ((value /= 10) > 0);
    line(key, std::string_view(&digits[first], digits.size() - first));
  }
  constexpr PluginStamp stamp() const { return stamp_; }

 private:
  constexpr void text(std::string_view words) {
    for (const char letter : words) stamp_.at(size_++) = letter;
  }

  PluginStamp stamp_{};
  std::size_t size_ = 0;
};

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
  else if constexpr (std::is_constructible_v<Implementation, const StageContext&>)
    object = new Implementation(context);
  else if constexpr (std::is_default_constructible_v<Implementation>)
    object = new Implementation();
  return object;
}

}  // namespace detail

/// An entry for a class with a constructor from (Options, const StageContext&) or (Options), or, if
/// it has no options, from (const StageContext&) or ().
template <class Interface, class Implementation>
constexpr PluginEntry provide(const char* type, const char* summary) {
  static_assert(std::is_base_of_v<Interface, Implementation>,
                "the class does not derive from the contract that it is provided for");
  static_assert(
      !std::is_abstract_v<Implementation>,
      "the class leaves out a function of its contract, or gives it other arguments, which "
      "'override' behind it would name");
  using Options = typename detail::OptionsOf<Implementation>::type;
  static_assert(std::is_abstract_v<Implementation> || std::is_same_v<Options, detail::NoOptions> ||
                    std::is_constructible_v<Implementation, Options, const StageContext&> ||
                    std::is_constructible_v<Implementation, Options>,
                "a class with Options needs a constructor that takes them, (Options) or (Options, "
                "const StageContext&): what users write in the pipeline file would be lost");
  static_assert(std::is_abstract_v<Implementation> || !std::is_same_v<Options, detail::NoOptions> ||
                    std::is_constructible_v<Implementation, const StageContext&> ||
                    std::is_default_constructible_v<Implementation>,
                "a class without Options needs a constructor from (const StageContext&) or ()");
  return {Interface::kKind,
          Interface::kApi,
          type,
          summary,
          &detail::describe<Implementation>,
          &detail::create<Interface, Implementation>};
}

/// At compile time; too many kinds do not compile.
constexpr PluginStamp stamp_of(std::span<const PluginEntry> entries, std::uint32_t api = kPluginApi,
                               std::string_view abi = kAbiTag) {
  detail::StampWriter writer;
  writer.line("stillpoint", "plugin");
  writer.line("api", api);
  writer.line("abi", abi);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    bool first = true;  // of its kind
    for (std::size_t j = 0; j < i; ++j)
      first = first && std::string_view(entries[j].kind) != entries[i].kind;
    if (first) writer.line(entries[i].kind, entries[i].kind_api);
  }
  return writer.stamp();
}

}  // namespace stillpoint

/// Once per library, at namespace scope: STILLPOINT_PLUGIN(name, "version", provide<…>(…), …);
#define STILLPOINT_PLUGIN(plugin_name, plugin_version, ...)                          \
  namespace {                                                                        \
  constexpr stillpoint::PluginEntry stillpoint_entries[] = {__VA_ARGS__};            \
  }                                                                                  \
  STILLPOINT_PLUGIN_STAMP(stillpoint::stamp_of(stillpoint_entries));                 \
  extern "C" STILLPOINT_EXPORT const stillpoint::PluginDescriptor stillpoint_plugin; \
  const stillpoint::PluginDescriptor stillpoint_plugin = {                           \
      #plugin_name, plugin_version, stillpoint_entries,                              \
      sizeof(stillpoint_entries) / sizeof(stillpoint_entries[0])}

/// Part of STILLPOINT_PLUGIN.
#define STILLPOINT_PLUGIN_STAMP(...)                                                             \
  extern "C" STILLPOINT_EXPORT constinit const stillpoint::PluginStamp stillpoint_plugin_stamp = \
      __VA_ARGS__
