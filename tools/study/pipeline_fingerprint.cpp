#include "study/pipeline_fingerprint.hpp"

#include <yaml-cpp/yaml.h>

#include <sstream>

namespace stillpoint::study {
namespace {

namespace fs = std::filesystem;

/// The text of each section, which begins in the first column.
std::vector<std::string> sections_of(const std::string& yaml) {
  std::vector<std::string> sections;
  std::istringstream lines(yaml);
  for (std::string line; std::getline(lines, line);) {
    if (sections.empty() || (!line.empty() && line[0] != ' ' && line[0] != '#'))
      sections.emplace_back();
    sections.back() += line + "\n";
  }
  return sections;
}

/// A network that is not where the pipeline says, by its name; empty: nowhere.
fs::path find_in(const std::vector<fs::path>& folders, const fs::path& name) {
  std::error_code ignored;
  for (const fs::path& folder : folders)
    if (fs::is_regular_file(folder / name, ignored)) return folder / name;
  return {};
}

/// Calls `add(text, is_value)` for keys and values in the order of the file; comments do not count.
/// Behind the last one of a list or map stands an empty key.
template <class Add>
void walk(const YAML::Node& node, const Add& add) {
  if (node.IsScalar()) return add(node.Scalar(), true);
  for (const auto& child : node) {
    if (node.IsMap()) add(child.first.Scalar(), false);
    walk(node.IsMap() ? child.second : YAML::Node(child), add);
  }
  add("", false);
}

}  // namespace

std::string PipelineFingerprints::of(const std::string& effective_pipeline,
                                     const fs::path& recording) {
  Fingerprint fingerprint;
  for (const std::string& section : sections_of(effective_pipeline))
    for (const Word& word : words_of(section)) {
      // The paths of an effective pipeline are absolute.
      if (!word.is_value || !word.text.starts_with('/'))
        fingerprint.add(word.text);
      else if (word.text != recording.string())
        add_path(word.text, fingerprint);
    }
  return fingerprint.add("").text();
}

const std::vector<PipelineFingerprints::Word>& PipelineFingerprints::words_of(
    const std::string& section) {
  const auto [known, is_new] = sections_.try_emplace(section);
  std::vector<Word>& words = known->second;
  if (!is_new) return words;
  walk(YAML::Load(section), [&](const std::string& text, bool is_value) {
    words.push_back({text, is_value});
  });
  words.pop_back();  // the end of the pipeline, which is not that of its section
  return words;
}

void PipelineFingerprints::add_path(const fs::path& path, Fingerprint& fingerprint) {
  std::error_code ignored;
  fingerprint.add(path.filename().string());
  if (fs::is_directory(path, ignored)) {
    for (const fs::directory_entry& file : files_below(path))
      fingerprint.add(fs::relative(file.path(), path).string())
          .add(contents_.fingerprint(file.path()));
  } else if (fs::is_regular_file(path, ignored)) {
    fingerprint.add(contents_.fingerprint(path));
  } else if (const fs::path found = find_in(folders_, path.filename()); !found.empty()) {
    fingerprint.add(contents_.fingerprint(found));
  }
}

}  // namespace stillpoint::study
