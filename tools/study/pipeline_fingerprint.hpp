// What a pipeline depends on, as a few letters.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "study/fingerprint.hpp"

namespace stillpoint::study {

/// Of pipelines with every option, and of the files and folders that they name besides their
/// recording, such as networks and labels: these count by name and content, not by the folder that
/// holds them, so that another installation of the same version has the same. For one thread.
class PipelineFingerprints {
 public:
  /// Networks are also looked for in `folders`, by name.
  explicit PipelineFingerprints(std::vector<std::filesystem::path> folders)
      : folders_(std::move(folders)) {}

  std::string of(const std::string& effective_pipeline, const std::filesystem::path& recording);

 private:
  /// A key or a value, in the order of the file.
  struct Word {
    std::string text;
    bool is_value;
  };
  const std::vector<Word>& words_of(const std::string& section);
  void add_path(const std::filesystem::path& path, Fingerprint& fingerprint);

  const std::vector<std::filesystem::path> folders_;
  FileContents contents_;
  std::map<std::string, std::vector<Word>> sections_;  // most pipelines of a study share most
};

}  // namespace stillpoint::study
