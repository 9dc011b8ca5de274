// stillpoint plugins new: the template of a kind with the name of the plugin put in. Templates are
// projects that compile as they are (sdk/templates): their plugin is called my_plugin, its class
// MyPlugin. What differs in texts stands between @.

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "shell_word.hpp"
#include "stillpoint/engine/install_layout.hpp"
#include "stillpoint/support/atomic_file.hpp"
#include "stillpoint/support/contract_list.hpp"
#include "stillpoint/support/did_you_mean.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;

struct NewPlugin {
  std::string kind, name;
  fs::path folder;
};

/// Contents by file name.
using Files = std::map<std::string, std::string>;

std::vector<std::string> kinds() {
  std::vector<std::string> kinds;
  for (const KindApi& contract : Contracts::kKinds) kinds.emplace_back(contract.kind);
  return kinds;
}

constexpr std::size_t kMaxName = 64;

// The name is that of a namespace, of a target of CMake and of files. Refused are the keywords of
// C++, CMake's own targets, and what the project uses itself.
constexpr std::string_view kTaken =
    " "
    "alignas alignof and and_eq asm auto bitand bitor bool break case catch char char16_t "
    "char32_t char8_t class co_await co_return co_yield compl concept const const_cast "
    "consteval constexpr constinit continue decltype default delete do double "
    "dynamic_cast else enum explicit export extern false float for friend goto if inline "
    "int long mutable namespace new noexcept not not_eq nullptr operator or or_eq private "
    "protected public register reinterpret_cast requires return short signed sizeof "
    "static static_assert static_cast struct switch template this thread_local throw true "
    "try typedef typeid typename union unsigned using virtual void volatile wchar_t while "
    "xor xor_eq "
    "all clean cv errno help install options package plugin plugins std stderr stdin "
    "stdout stillpoint test testing ";

void require_kind(const std::string& kind) {
  if (std::ranges::find(Contracts::kKinds, kind, &KindApi::kind) != Contracts::kKinds.end()) return;
  throw Error(Fault::kUsage, "there is no kind of plugin '" + kind + "'" +
                                 did_you_mean(kind, kinds()) + "\n  available: " + join(kinds()));
}

bool is_snake_case(const std::string& name) {
  if (name.empty() || !std::islower(static_cast<unsigned char>(name.front()))) return false;
  if (name.back() == '_' || name.find("__") != std::string::npos) return false;
  return std::ranges::all_of(name, [](unsigned char letter) {
    return letter < 128 && (std::islower(letter) || std::isdigit(letter) || letter == '_');
  });
}

void require_name(const std::string& name) {
  if (name.size() > kMaxName)
    throw Error(Fault::kUsage, "the name of the plugin has " + std::to_string(name.size()) +
                                   " characters; take at most " + std::to_string(kMaxName));
  if (!is_snake_case(name))
    throw Error(Fault::kUsage, "'" + name + "' cannot be the name of a plugin", "",
                "take lower-case letters, digits and single underscores, beginning with a letter, "
                "as in my_plugin");
  if (kTaken.find(" " + name + " ") != std::string_view::npos)
    throw Error(
        Fault::kUsage,
        "'" + name + "' cannot be the name of a plugin: in C++ or CMake it means something else",
        "", "take another one, as in my_" + name);
}

/// A plugin of one's own replaces the one of its type that is there wherever its folder is searched
/// first.
void require_new_type(const NewPlugin& plugin) {
  const LateCalls late = watch_loading();
  Registry registry;
  for (const fs::path& folder : default_plugin_folders()) registry.search(folder);
  if (const PluginType* type = registry.find(plugin.kind, plugin.name))
    throw Error(Fault::kUsage,
                "'" + plugin.name + "' is already a type of " + plugin.kind + ", in " +
                    type->library.string(),
                "", "take another name, as in my_" + plugin.name);
}

void require_free(const fs::path& folder) {
  std::error_code error;
  const fs::file_status status = fs::status(folder, error);
  if (status.type() == fs::file_type::not_found) return;
  if (!error && !fs::is_directory(status))
    throw Error(Fault::kUsage, "is not a folder", folder.string(), "name another one with -o");
  const bool empty = !error && fs::is_empty(folder, error);
  if (error) throw Error(Fault::kUsage, "cannot be read: " + error.message(), folder.string());
  if (!empty)
    throw Error(Fault::kUsage, "there is something in this folder already", folder.string(),
                "name another one with -o");
}

std::string camel_case(const std::string& name) {
  std::string result;
  bool upper = true;
  for (const char letter : name) {
    if (letter != '_') result += upper ? static_cast<char>(std::toupper(letter)) : letter;
    upper = letter == '_';
  }
  return result;
}

/// Without the last number of the version: what find_package asks for.
std::string minor_version() {
  const std::string version = STILLPOINT_VERSION;
  return version.substr(0, version.rfind('.'));
}

/// A recording to try it with, and a run. `in` precedes every path.
std::vector<std::string> run_commands(const std::string& kind, const std::string& program,
                                      const fs::path& in) {
  const auto path = [&](const char* name) { return shell_word((in / name).string()); };
  const std::string run = program + " run " + path("pipeline.yaml");
  if (kind == Source::kKind) return {run + " -o " + path("out")};
  return {program + " simulate fr3_walking_xyz --frames 60 -o " + path("recording"),
          run + " --dataset " + path("recording") + " -o " + path("out")};
}

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
}

std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string text(std::istreambuf_iterator<char>(stream), {});
  if (!stream)
    throw Error(Fault::kUsage, std::string("cannot be read: ") + std::strerror(errno),
                file.string(), "the package libstillpoint-dev has it");
  return text;
}

Files files_in(const fs::path& folder) {
  std::error_code error;
  Files files;
  for (const auto& entry : fs::directory_iterator(folder, error))
    files[entry.path().filename().string()] = text_of(entry.path());
  if (error)
    throw Error(Fault::kUsage, "cannot be read: " + error.message(), folder.string(),
                "the package libstillpoint-dev has it");
  return files;
}

Files project_of(const NewPlugin& plugin) {
  const fs::path templates = installation_folder() / "share/stillpoint/templates";
  Files files = files_in(templates / plugin.kind);
  files.merge(files_in(templates / "common"));
  // Packages should hold no .gitignore (lintian: package-contains-vcs-control-file).
  if (auto ignored = files.extract("gitignore")) {
    ignored.key() = ".gitignore";
    files.insert(std::move(ignored));
  }
  std::string about = std::move(files["about.md"]);
  files.erase("about.md");
  about.erase(about.find_last_not_of('\n') + 1);
  const std::string run = join(run_commands(plugin.kind, "stillpoint", ""), "\n");
  const std::vector<std::pair<std::string_view, std::string>> replacements = {
      {"@about@", about},         {"@run@", run},
      {"@kind@", plugin.kind},    {"@version@", minor_version()},
      {"my_plugin", plugin.name}, {"MyPlugin", camel_case(plugin.name)}};
  Files project;
  for (const auto& [template_name, template_text] : files) {
    std::string name = template_name, text = template_text;
    for (const auto& [from, to] : replacements) {
      replace_all(name, from, to);
      replace_all(text, from, to);
    }
    project[name] = std::move(text);
  }
  return project;
}

/// All of them or, with an Error, none.
void write(const Files& files, const fs::path& folder) {
  std::vector<fs::path> made;  // innermost first
  std::error_code ignored;
  for (fs::path path = folder; !path.empty() && !fs::exists(path, ignored);
       path = path.parent_path())
    made.push_back(path);
  std::vector<fs::path> written;
  try {
    for (const auto& [name, text] : files) {
      AtomicFile file(folder / name);
      file.stream() << text;
      file.commit();
      written.push_back(folder / name);
    }
  } catch (const Error&) {
    for (const fs::path& file : written) fs::remove(file, ignored);
    for (const fs::path& path : made) fs::remove(path, ignored);
    throw;
  }
}

/// The folder of PATH that the shell takes the program from, if it is this one.
std::optional<fs::path> folder_on_path(const fs::path& program) {
  const char* value = std::getenv("PATH");
  std::istringstream folders(value ? value : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    std::error_code error;
    const fs::path candidate = fs::path(folder) / program.filename();
    if (!fs::exists(candidate, error)) continue;
    return fs::equivalent(candidate, program, error) ? std::optional<fs::path>(folder)
                                                     : std::nullopt;
  }
  return std::nullopt;
}

/// Commands that work as they are in the user's working folder.
void print_next_steps(const NewPlugin& plugin) {
  const fs::path prefix = installation_folder();
  const fs::path executable = fs::read_symlink("/proc/self/exe");
  const std::optional<fs::path> on_path = folder_on_path(executable);
  const std::string program = on_path ? "stillpoint" : shell_word(executable.string());
  const std::string build = shell_word((plugin.folder / "build").string());
  std::string configure = "cmake -S " + shell_word(plugin.folder.string()) + " -B " + build;
  if (!installation_has_sdk()) {
    std::cout
        << "\nThis Stillpoint is not installed, and a plugin is built against an installation. "
           "Put its\nfolder for DIR:\n  cmake --install "
        << shell_word(prefix.string()) << " --prefix DIR\n";
    configure += " -D CMAKE_PREFIX_PATH=DIR";
  } else if (std::error_code error;  // CMake looks beside the folders of PATH
             !on_path || !fs::equivalent(on_path->parent_path(), prefix, error)) {
    configure += " -D CMAKE_PREFIX_PATH=" + shell_word(prefix.string());
  }
  std::vector<std::string> commands = {configure, "cmake --build " + build,
                                       "ctest --test-dir " + build + " --output-on-failure",
                                       program + " plugins --path " + build + " list"};
  std::ranges::move(run_commands(plugin.kind, program, plugin.folder),
                    std::back_inserter(commands));
  std::cout << "\nbuild, test and run it:\n";
  for (const std::string& command : commands) std::cout << "  " << command << '\n';
}

void make(NewPlugin plugin) {
  require_kind(plugin.kind);
  require_name(plugin.name);
  require_new_type(plugin);
  if (plugin.folder.empty()) plugin.folder = plugin.name;
  require_free(plugin.folder);
  const Files project = project_of(plugin);
  write(project, plugin.folder);
  std::cout << "made a project of kind " << plugin.kind << " in " << plugin.folder.string()
            << ":\n ";
  for (const auto& [name, text] : project) std::cout << ' ' << name;
  std::cout << '\n';
  print_next_steps(plugin);
}

}  // namespace

void add_plugins_new(CLI::App& plugins) {
  CLI::App* command = plugins.add_subcommand(
      "new", "A project for a plugin of your own, as in 'new moving_checker my_check'");
  auto plugin = std::make_shared<NewPlugin>();
  command->add_option("kind", plugin->kind, "What it implements: " + join(kinds()))
      ->type_name("KIND")
      ->required();
  command->add_option("name", plugin->name, "Its name, like_this")->type_name("NAME")->required();
  command->add_option("-o,--output", plugin->folder, "Folder to make; default: ./NAME")
      ->type_name("DIR");
  command->callback([plugin] { make(*plugin); });
}

}  // namespace stillpoint
