#include "study_check.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <functional>
#include <sstream>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "stillpoint/engine/config_lookup.hpp"
#include "stillpoint/error.hpp"
#include "stillpoint/runtime/pipeline_tree.hpp"
#include "stillpoint/support/did_you_mean.hpp"
#include "study/matrix.hpp"
#include "study_file.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;
using study::Sequence;
using study::Study;
using study::Variant;

template <class Named>
std::vector<std::string> names_of(const std::vector<Named>& list) {
  std::vector<std::string> names;
  for (const Named& element : list) names.push_back(element.name);
  return names;
}

/// They become folders and cells of tables.
bool is_usable_name(const std::string& name) {
  return !name.empty() && name.front() != '.' && std::ranges::all_of(name, [](unsigned char c) {
    return std::isalnum(c) || c == '_' || c == '-' || c == '.' || c == '+';
  });
}

/// The messages of a ConfigError; those of several lines stay together.
std::vector<std::string> messages_of(const std::string& text) {
  std::vector<std::string> messages;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);)
    if (messages.empty() || line.find(": error: ") != std::string::npos)
      messages.push_back(line);
    else
      messages.back() += "\n" + line;
  return messages;
}

/// Of a message of the command line, "--set a=1: error: …", which stands behind another "error:".
std::string without_error(std::string message) {
  const std::string_view word = "error: ";
  const std::size_t at = message.find(word);
  return at == std::string::npos ? message : message.erase(at, word.size());
}

class StudyChecker {
 public:
  StudyChecker(const ConfigNode& tree, const Study& study, Registry& registry, FaultList faults)
      : tree_(tree), study_(study), registry_(registry), faults_(std::move(faults)) {}

  void check() {
    check_names("sequences", names_of(study_.sequences));
    check_names("variants", names_of(study_.variants));
    check_name_in(names_of(study_.variants), study_.baseline, place("baseline"), "variant");
    for (std::size_t i = 0; i < study_.sequences.size(); ++i) check_sequence(i);
    for (std::size_t i = 0; i < study_.variants.size(); ++i) check_variant(i);
    for (std::size_t i = 0; i < study_.published.size(); ++i) check_published(i);
    throw_if_any();
  }

 private:
  /// Of a key of the study, or else of the study.
  Location place(const char* key) const {
    const ConfigNode* node = tree_.find(key);
    return node ? node->location : tree_.location;
  }
  /// Of a key of an element of a list, or else of the element.
  Location place(const char* list, std::size_t i, const char* key) const {
    const ConfigNode* elements = tree_.find(list);
    if (!elements || i >= elements->children.size()) return place(list);
    const ConfigNode* node = elements->children[i].find(key);
    return node ? node->location : elements->children[i].location;
  }

  bool has_name(const char* list, std::size_t i) const {
    const ConfigNode* elements = tree_.find(list);
    return elements && i < elements->children.size() && elements->children[i].find("name");
  }

  void check_names(const char* list, const std::vector<std::string>& names) {
    if (names.empty() && tree_.find(list))
      faults_.add(place(list), std::string(list) + " is empty");
    std::unordered_set<std::string> earlier;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (names[i].empty() && !has_name(list, i)) continue;  // which is known
      if (!is_usable_name(names[i]))
        faults_.add(place(list, i, "name"),
                    "'" + names[i] + "' also names a folder: letters, digits and _ - + . only");
      if (!earlier.insert(names[i]).second)
        faults_.add(place(list, i, "name"), "'" + names[i] + "' is given twice");
    }
  }

  void check_name_in(const std::vector<std::string>& known, const std::string& name,
                     const Location& where, const std::string& what) {
    if (name.empty() || std::ranges::find(known, name) != known.end()) return;
    const std::string hint = did_you_mean(name, known);
    faults_.add(where, "no " + what + " named '" + name + "'" +
                           (hint.empty() ? "; there are: " + join(known) : hint));
  }

  void check_sequence(std::size_t i) {
    const Sequence& sequence = study_.sequences[i];
    check_name_in(names_of(study_.sequences), sequence.empty_scene,
                  place("sequences", i, "empty_scene"), "sequence");
    std::error_code error;
    if (!sequence.dataset.empty() &&
        !fs::is_regular_file(fs::path(sequence.dataset) / "groundtruth.txt", error))
      faults_.add(place("sequences", i, "dataset"),
                  "'" + sequence.dataset +
                      (fs::is_directory(sequence.dataset, error)
                           ? "' has no groundtruth.txt, which the study compares with"
                       : fs::is_regular_file(sequence.dataset, error)
                           ? "' is no folder; 'stillpoint record PIPELINE --dataset BAG -o DIR' "
                             "makes one of a bag, which then needs a groundtruth.txt"
                           : "' is no folder"));
    if (!sequence.scene.empty())
      collect("sequences", i, "scene", [&] { describe_scene(sequence); });
    if (!sequence.camera.empty())
      collect("sequences", i, "camera", [&] { load_camera(sequence.camera); });
  }

  void check_variant(std::size_t i) {
    const Variant& variant = study_.variants[i];
    for (const char* key : {"only", "skip"})
      for (const std::string& name : key[0] == 'o' ? variant.only : variant.skip)
        check_name_in(names_of(study_.sequences), name, place("variants", i, key), "sequence");
    if (variant.pipeline.empty()) return;
    // What differs between sequences, the recording and its camera, has been checked with them.
    const auto sequence = std::ranges::find_if(
        study_.sequences, [&](const Sequence& s) { return study::is_wanted(variant, s.name); });
    if (sequence == study_.sequences.end()) return;
    const fs::path recording = study::recording_of(
        "recordings", study_, static_cast<std::size_t>(sequence - study_.sequences.begin()), 0);
    collect("variants", i, "pipeline", [&] {
      PipelineRequest request = request_of(study_, *sequence, variant, recording);
      request.camera.clear();
      check_outputs(i, load_pipeline(request, registry_, files_));
    });
  }

  void check_published(std::size_t i) {
    std::vector<std::string> originals;
    for (const Sequence& sequence : study_.sequences) originals.push_back(original_of(sequence));
    const ConfigNode* list = tree_.find("published");
    const ConfigNode* errors = list->children[i].find("errors");
    if (!errors) return;
    for (const ConfigNode& recording : errors->children)
      check_name_in(originals, recording.key, recording.key_location, "recording");
  }

  void check_outputs(std::size_t i, const PipelineConfig& config) {
    for (const char* needed : {"trajectory", "summary"})
      if (std::ranges::none_of(config.outputs, [&](const OutputSpec& output) {
            return output.stage.type() == needed;
          }))
        faults_.add(place("variants", i, "pipeline"),
                    "variant '" + study_.variants[i].name + "': its pipeline has no output '" +
                        needed + "', from which the figures come");
  }

  /// Faults of other files stay as they are; those of `set` belong to the list in this file, all
  /// others to `key`.
  void collect(const char* list, std::size_t i, const char* key,
               const std::function<void()>& load) {
    try {
      load();
    } catch (const ConfigError& error) {
      for (const std::string& message : messages_of(error.what()))
        if (message.starts_with("--"))
          faults_.add(place_of_set(list, i, message), without_error(message));
        else if (std::ranges::find(others_, message) == others_.end())
          others_.push_back(message);
    } catch (const Error& error) {
      faults_.add(place(list, i, key), error.what());
    }
  }

  /// The `set` that says it: of the element of the list, or of the study.
  Location place_of_set(const char* list, std::size_t i, const std::string& message) const {
    const ConfigNode* shared = tree_.find("set");
    if (shared)
      for (const ConfigNode& assignment : shared->children)
        if (message.starts_with("--set " + assignment.scalar + ":")) return assignment.location;
    return place(list, i, "set");
  }

  void throw_if_any() const {
    std::string lines = join(others_, "\n");
    try {
      faults_.throw_if_any();
    } catch (const ConfigError& error) {
      lines = error.what() + (lines.empty() ? "" : "\n" + lines);
    }
    if (!lines.empty()) throw ConfigError(lines);
  }

  const ConfigNode& tree_;
  const Study& study_;
  Registry& registry_;
  ConfigFiles files_;
  FaultList faults_;
  std::vector<std::string> others_;  // of pipelines and scenes
};

}  // namespace

void check_study(const ConfigNode& tree, const Study& study, Registry& registry, FaultList faults) {
  StudyChecker(tree, study, registry, std::move(faults)).check();
}

}  // namespace stillpoint
