#include "study/fingerprint.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <sstream>

#include "stillpoint/error.hpp"
#include "study/text_file.hpp"

namespace stillpoint::study {
namespace {

namespace fs = std::filesystem;

// Lists, poses, cameras: small, and the same size does not mean the same content.
bool is_text(const fs::path& file) {
  return file.extension() == ".txt" || file.extension() == ".yaml";
}

std::vector<fs::directory_entry> files_below(const fs::path& folder) {
  std::vector<fs::directory_entry> files;
  for (const fs::directory_entry& entry :
       fs::recursive_directory_iterator(folder, fs::directory_options::follow_directory_symlink))
    if (entry.is_regular_file()) files.push_back(entry);
  std::ranges::sort(files);
  return files;
}

void add_file(Fingerprint& fingerprint, const fs::path& file) {
  std::error_code ignored;  // a file that cannot be seen is the same again next time
  fingerprint.add(file.string())
      .add(std::to_string(fs::file_size(file, ignored)))
      .add(std::to_string(fs::last_write_time(file, ignored).time_since_epoch().count()));
}

/// The paths of an effective pipeline are absolute; a network that is not there is found by name.
void add_named(Fingerprint& fingerprint, const fs::path& named,
               const std::vector<fs::path>& folders) {
  std::error_code ignored;
  if (!named.is_absolute()) return;
  if (fs::is_regular_file(named, ignored)) return add_file(fingerprint, named);
  if (fs::is_directory(named, ignored)) {
    for (const fs::directory_entry& file : files_below(named)) add_file(fingerprint, file.path());
    return;
  }
  for (const fs::path& folder : folders)
    if (fs::is_regular_file(folder / named.filename(), ignored))
      add_file(fingerprint, folder / named.filename());
}

void collect_scalars(const YAML::Node& node, std::vector<std::string>& scalars) {
  if (node.IsScalar()) scalars.push_back(node.Scalar());
  for (const auto& child : node)
    collect_scalars(node.IsMap() ? child.second : YAML::Node(child), scalars);
}

}  // namespace

Fingerprint& Fingerprint::add(std::string_view text) {
  constexpr std::uint64_t kPrime = 1099511628211u;
  for (const char c : text) hash_ = (hash_ ^ static_cast<unsigned char>(c)) * kPrime;
  hash_ *= kPrime;  // an end, so that "ab" + "c" is not "a" + "bc"
  return *this;
}

std::string Fingerprint::text() const {
  std::array<char, 17> digits{};
  std::snprintf(digits.data(), digits.size(), "%016llx", static_cast<unsigned long long>(hash_));
  return digits.data();
}

std::string recording_fingerprint(const fs::path& recording) {
  try {
    Fingerprint fingerprint;
    for (const fs::directory_entry& file : files_below(recording)) {
      fingerprint.add(fs::relative(file.path(), recording).string());
      fingerprint.add(is_text(file) ? read_text(file) : std::to_string(file.file_size()));
    }
    return fingerprint.text();
  } catch (const fs::filesystem_error& error) {
    throw Error(Fault::kData, std::string("cannot be read: ") + error.code().message(),
                recording.string());
  }
}

std::string input_fingerprint(const std::string& effective_pipeline, const fs::path& recording,
                              const std::vector<fs::path>& folders) {
  // Each option is a line of its own, and reading all of them takes most of the time that planning
  // a large study takes.
  std::vector<std::string> scalars;
  std::istringstream lines(effective_pipeline);
  for (std::string line; std::getline(lines, line);)
    if (line.find('/') != std::string::npos) collect_scalars(YAML::Load(line), scalars);
  Fingerprint fingerprint;
  for (const std::string& scalar : scalars)
    if (scalar != recording.string()) add_named(fingerprint, scalar, folders);
  return fingerprint.text();
}

std::string cell_fingerprint(const std::string& effective_pipeline, const std::string& inputs,
                             int seed) {
  return Fingerprint().add(effective_pipeline).add(inputs).add(std::to_string(seed)).text();
}

std::string program_fingerprint(const std::vector<fs::path>& files) {
  Fingerprint fingerprint;
  for (const fs::path& file : files) add_file(fingerprint, file);
  return fingerprint.text();
}

}  // namespace stillpoint::study
