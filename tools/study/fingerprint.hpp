// What a result depends on, as a few letters: when they differ, it has to be made again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace stillpoint::study {

/// FNV-1a, 64 bits. The order of what is added counts.
class Fingerprint {
 public:
  Fingerprint& add(std::string_view text);
  std::string text() const;  ///< 16 hexadecimal digits

 private:
  std::uint64_t hash_ = 14695981039346656037u;
};

/// All files below a folder, links followed, sorted. Throws std::filesystem::filesystem_error.
std::vector<std::filesystem::directory_entry> files_below(const std::filesystem::path& folder);

/// Of a recording: what its lists and YAML files say, and the names and sizes of all other files.
/// Images are not read. Throws Error(kData) when the folder cannot be read.
std::string recording_fingerprint(const std::filesystem::path& recording);

/// What is in files, whatever they are called and wherever they lie. Each is read once, and again
/// when its size or time of change has become another. For one thread.
class FileContents {
 public:
  /// Also of a file that cannot be read: as if it were empty.
  std::string fingerprint(const std::filesystem::path& file);

 private:
  struct Known {
    std::uintmax_t size;
    std::filesystem::file_time_type changed;
    std::string fingerprint;
  };
  std::map<std::filesystem::path, Known> known_;
};

/// Of a run: the fingerprints of its pipeline and its recording, and the seed.
std::string cell_fingerprint(const std::string& pipeline, const std::string& recording, int seed);

/// Of the program, its libraries and plugins: their names and contents.
std::string program_fingerprint(const std::vector<std::filesystem::path>& files,
                                FileContents& contents);

}  // namespace stillpoint::study
