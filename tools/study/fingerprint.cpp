#include "study/fingerprint.hpp"

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

std::vector<fs::directory_entry> files_below(const fs::path& folder) {
  std::vector<fs::directory_entry> files;
  for (const fs::directory_entry& entry :
       fs::recursive_directory_iterator(folder, fs::directory_options::follow_directory_symlink))
    if (entry.is_regular_file()) files.push_back(entry);
  std::ranges::sort(files);
  return files;
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
