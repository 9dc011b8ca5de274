// Which files in the folder of a run are results, and which of these an earlier run has left.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace stillpoint {

inline constexpr const char* kRunLog = "log.txt";
inline constexpr const char* kRunPipeline = "pipeline.yaml";
inline constexpr const char* kRunMap = "sparse.map";  // where the live view saves it

/// What the outputs of a pipeline write under names that it gives them, as paths from the run
/// folder.
struct NamedResults {
  std::multiset<std::string> files;
  std::set<std::string> picture_folders;  ///< with numbered pictures
};

/// Of an effective pipeline. Throws Error(kUsage) where one result would replace another.
NamedResults named_results(const std::string& effective_yaml);
/// Of the run that was in the folder before, by its pipeline.yaml; without one, nothing.
NamedResults earlier_named_results(const std::filesystem::path& run);
/// Files that are there, which a run of `own` would replace and one of `earlier` has not named. Not
/// pipes and devices, which are there to be written into, nor files outside the folder, which are
/// for the newest run.
std::vector<std::filesystem::path> files_in_the_way(const std::filesystem::path& run,
                                                    const NamedResults& own,
                                                    const NamedResults& earlier);
/// Whether a normalised path leads out of the run folder.
bool is_elsewhere(const std::filesystem::path& file);

/// Results with fixed names, whether they are there or not; the log is none.
std::vector<std::filesystem::path> fixed_results(const std::filesystem::path& run);
/// Whether a path from the run folder is one of them.
bool is_fixed_result(const std::filesystem::path& file);

std::vector<std::filesystem::path> pictures_in(const std::filesystem::path& folder);
/// Files that a killed run of `named` has left under their temporary names.
std::vector<std::filesystem::path> unfinished_in(const std::filesystem::path& run,
                                                 const NamedResults& named);
/// Files with the names of `named` that are there: of a killed run, which leaves no list, those
/// that grew where they are.
std::vector<std::filesystem::path> files_with_names_in(const std::filesystem::path& run,
                                                       const NamedResults& named);
/// Whether the file is a log that a run has begun.
bool is_log_of_a_run(const std::filesystem::path& file);

}  // namespace stillpoint
