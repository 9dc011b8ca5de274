#include "stillpoint/engine/config_lookup.hpp"

#include <set>
#include <vector>

#include "stillpoint/engine/install_layout.hpp"
#include "stillpoint/error.hpp"
#include "stillpoint/support/did_you_mean.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;

bool is_config_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

std::string singular_of(const std::string& category) {
  if (category.ends_with("ies")) return category.substr(0, category.size() - 3) + "y";
  return category.substr(0, category.size() - 1);
}

}  // namespace

fs::path find_config(const std::string& name_or_file, const std::string& category,
                     const fs::path& folder) {
  const fs::path from_folder = (folder / name_or_file).lexically_normal();
  if (is_config_file(from_folder)) return from_folder;
  const std::string singular = singular_of(category);
  const fs::path path = name_or_file;
  if (path.has_parent_path() || path.extension() == ".yaml")
    throw Error(Fault::kUsage, "no such " + singular + " file", from_folder.string());
  for (const fs::path& configs : config_folders())
    if (const fs::path file = configs / category / (name_or_file + ".yaml"); is_config_file(file))
      return file;
  const std::vector<std::string> names = config_names(category);
  throw Error(Fault::kUsage, "no " + singular + " named '" + name_or_file + "'" +
                                 did_you_mean(name_or_file, names) +
                                 (names.empty() ? "" : "\n  available: " + join(names)));
}

std::vector<std::string> config_names(const std::string& category) {
  std::set<std::string> names;
  std::error_code error;
  for (const fs::path& folder : config_folders())
    for (const auto& entry : fs::directory_iterator(folder / category, error))
      if (entry.path().extension() == ".yaml") names.insert(entry.path().stem());
  return {names.begin(), names.end()};
}

}  // namespace stillpoint
