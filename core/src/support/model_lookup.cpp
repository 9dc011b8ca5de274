#include "stillpoint/support/model_lookup.hpp"

#include <dlfcn.h>

#include <cstdlib>
#include <sstream>

#include "stillpoint/error.hpp"
#include "stillpoint/support/did_you_mean.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

bool is_file(const fs::path& file) {
  std::error_code ignored;
  return fs::exists(file, ignored) && !fs::is_directory(file, ignored);
}

}  // namespace

fs::path folder_of(const void* code) {
  Dl_info info{};
  if (dladdr(code, &info) == 0) return {};
  std::error_code failed;
  const fs::path file = fs::canonical(info.dli_fname, failed);
  return failed ? fs::path() : file.parent_path();
}

std::vector<fs::path> model_folders(const void* own_code) {
  std::vector<fs::path> folders;
  std::istringstream listed(environment("STILLPOINT_MODEL_PATH"));
  for (std::string folder; std::getline(listed, folder, ':');)
    if (!folder.empty()) folders.emplace_back(folder);
  if (const fs::path own = folder_of(own_code); !own.empty()) folders.push_back(own / "models");
  if (const std::string data = environment("XDG_DATA_HOME"); !data.empty())
    folders.push_back(fs::path(data) / "stillpoint/models");
  else if (const std::string home = environment("HOME"); !home.empty())
    folders.push_back(fs::path(home) / ".local/share/stillpoint/models");
  return folders;
}

fs::path find_model(const std::string& file, const void* own_code) {
  if (is_file(file)) return file;
  std::vector<std::string> searched = {file};
  for (const fs::path& folder : model_folders(own_code)) {
    fs::path candidate = folder / fs::path(file).filename();
    if (is_file(candidate)) return candidate;
    searched.push_back(candidate.string());
  }
  throw Error(
      Fault::kUsage, "the network's file does not exist; searched: " + join(searched), file,
      "'stillpoint-get-models --help' (tools/get_models of the sources) lists those that it "
      "fetches; where another one comes from, its file in configs/segmenters says; "
      "STILLPOINT_MODEL_PATH names more folders to search");
}

}  // namespace stillpoint
