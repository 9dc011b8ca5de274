#include "study/fingerprint.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cstdio>

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

class PipelinePrinter {
 public:
  PipelinePrinter(const fs::path& recording, const std::vector<fs::path>& folders,
                  FileContents& contents)
      : recording_(recording.string()), folders_(folders), contents_(contents) {}

  /// Keys and values in the order of the file; comments do not count.
  void add(const YAML::Node& node) {
    if (node.IsScalar()) return add_value(node.Scalar());
    for (const auto& child : node) {
      if (node.IsMap()) fingerprint_.add(child.first.Scalar());
      add(node.IsMap() ? child.second : YAML::Node(child));
    }
    fingerprint_.add("");  // an end
  }

  std::string text() const { return fingerprint_.text(); }

 private:
  /// The paths of an effective pipeline are absolute.
  void add_value(const std::string& value) {
    const fs::path path = value;
    if (!path.is_absolute())
      fingerprint_.add(value);
    else if (value != recording_)
      add_path(path);
  }

  void add_path(const fs::path& path) {
    std::error_code ignored;
    fingerprint_.add(path.filename().string());
    if (fs::is_directory(path, ignored)) {
      for (const fs::directory_entry& file : files_below(path))
        fingerprint_.add(fs::relative(file.path(), path).string())
            .add(contents_.fingerprint(file.path()));
    } else if (fs::is_regular_file(path, ignored)) {
      fingerprint_.add(contents_.fingerprint(path));
    } else if (const auto found = find(path.filename()); !found.empty()) {
      fingerprint_.add(contents_.fingerprint(found));
    }
  }

  /// A network that is not where the pipeline says, by its name.
  fs::path find(const fs::path& name) const {
    std::error_code ignored;
    for (const fs::path& folder : folders_)
      if (fs::is_regular_file(folder / name, ignored)) return folder / name;
    return {};
  }

  const std::string recording_;
  const std::vector<fs::path>& folders_;
  FileContents& contents_;
  Fingerprint fingerprint_;
};

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

std::string FileContents::fingerprint(const fs::path& file) {
  std::error_code ignored;
  const std::uintmax_t size = fs::file_size(file, ignored);
  const fs::file_time_type changed = fs::last_write_time(file, ignored);
  const auto known = known_.find(file);
  if (known != known_.end() && known->second.size == size && known->second.changed == changed)
    return known->second.fingerprint;
  std::string text = Fingerprint().add(read_text(file)).text();
  known_.insert_or_assign(file, Known{size, changed, text});
  return text;
}

std::string pipeline_fingerprint(const std::string& effective_pipeline, const fs::path& recording,
                                 const std::vector<fs::path>& folders, FileContents& contents) {
  PipelinePrinter printer(recording, folders, contents);
  printer.add(YAML::Load(effective_pipeline));
  return printer.text();
}

std::string cell_fingerprint(const std::string& pipeline, const std::string& recording, int seed) {
  return Fingerprint().add(pipeline).add(recording).add(std::to_string(seed)).text();
}

std::string program_fingerprint(const std::vector<fs::path>& files, FileContents& contents) {
  Fingerprint fingerprint;
  for (const fs::path& file : files)
    fingerprint.add(file.filename().string()).add(contents.fingerprint(file));
  return fingerprint.text();
}

}  // namespace stillpoint::study
