// Lists of recordings with people, in YAML: where the photographs are, which recordings to paste
// into, and what to make of them (tools/people/plans.hpp).
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "people/plans.hpp"
#include "stillpoint/engine/pipeline_config.hpp"
#include "stillpoint/runtime/yaml_loader.hpp"
#include "stillpoint/runtime/yaml_option_reader.hpp"

namespace stillpoint::testing {

struct PeopleList {
  std::vector<std::string> people_from;    ///< folders of photographs with masks
  std::vector<std::string> pictures_from;  ///< folders of photographs without
  std::map<std::string, people::BasePlan> bases;
  std::vector<people::RecordingPlan> recordings;

  void visit(OptionVisitor& v) {
    v("people_from", people_from, {.help = "folders of photographs with masks"});
    v("pictures_from", pictures_from, {.help = "folders of photographs for the sides of things"});
    v("bases", bases, {.help = "recordings without people, by name"});
    v("recordings", recordings, {.help = "what to make"});
    for (const people::RecordingPlan& recording : recordings)
      v.require(bases.contains(recording.base), "every recording has one of the bases");
  }
};

/// Throws ConfigError with every fault of the file.
inline PeopleList load_people_list(const std::filesystem::path& file) {
  FaultList faults;
  ConfigNode tree = load_config_file(file, "recordings", faults);
  substitute_environment(tree, faults);
  remove_nulls(tree);
  YamlOptionReader reader(&tree, "recordings");
  reader.ignore("version");
  PeopleList list;
  list.visit(reader);
  reader.finish();
  faults.add(reader.faults());
  faults.throw_if_any();
  return list;
}

/// The named camera of a base, or the one that lies beside it.
inline CameraModel camera_of(const people::BasePlan& base) {
  return load_camera(base.camera.empty()
                         ? (std::filesystem::path(base.folder) / "camera.yaml").string()
                         : base.camera);
}

}  // namespace stillpoint::testing
