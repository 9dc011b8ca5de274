// What a result depends on, as a few letters: when they differ, it has to be made again.
#pragma once

#include <cstdint>
#include <filesystem>
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

/// Of a recording: what its lists and YAML files say, and the names and sizes of all other files.
/// Images are not read. Throws Error(kData) when the folder cannot be read.
std::string recording_fingerprint(const std::filesystem::path& recording);

/// Of the files and folders that a pipeline names besides its recording, such as networks and
/// labels: their sizes and times of change. Networks are also looked for in `folders`, by name.
std::string input_fingerprint(const std::string& effective_pipeline,
                              const std::filesystem::path& recording,
                              const std::vector<std::filesystem::path>& folders);

/// Of a run: the complete pipeline, the fingerprints of what it reads, and the seed.
std::string cell_fingerprint(const std::string& effective_pipeline, const std::string& inputs,
                             int seed);

/// Of the program, its libraries and plugins: their sizes and times of change.
std::string program_fingerprint(const std::vector<std::filesystem::path>& files);

}  // namespace stillpoint::study
