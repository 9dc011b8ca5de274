// Study files: read and checked as a whole, with every pipeline and scene they name.
#pragma once

#include <filesystem>
#include <string>

#include "stillpoint/engine/pipeline_config.hpp"
#include "study/study.hpp"

namespace stillpoint {

struct StudyFile {
  std::filesystem::path file;
  study::Study study;
  std::string effective_yaml;  ///< every option with its value, paths absolute
};

/// A file, or a name from configs/studies. Plugins stay in `registry`. Throws ConfigError with
/// every fault of the study, its pipelines and its scenes, or Error when there is no such file.
StudyFile load_study(const std::string& name_or_file, Registry& registry);

/// The study that `ablate` has recorded as study.yaml; its pipelines, scenes and recordings are not
/// looked at. Throws ConfigError with every fault.
study::Study recorded_study(const std::filesystem::path& file);

/// What `stillpoint run` is told for a variant on a sequence whose recording lies in `recording`;
/// the seed is missing.
PipelineRequest request_of(const study::Study& study, const study::Sequence& sequence,
                           const study::Variant& variant, const std::filesystem::path& recording);

/// All that a simulated recording depends on. Throws as load_scene does.
std::string describe_scene(const study::Sequence& sequence);

}  // namespace stillpoint
