// One folder, one study: results of two in one folder would replace each other.
#pragma once

#include <filesystem>
#include <string>

namespace stillpoint::study {

/// What a study writes into its folder when it ends, beside its claim, its runs and recordings.
inline constexpr const char* kResultFiles[] = {"study.yaml", "results.csv", "summary.csv",
                                               "tables.tex", "results.md"};

/// Writes `folder`/study.json, which says whose folder it is, and by which command. Another study
/// is one of another name, or of the same name from a file with other content, while the first file
/// is still there: a study may be edited, moved and read from another installation. Throws
/// Error(kUsage) that names both when the folder is another's, and where no study has claimed it
/// but a file has the name of a result.
void claim_folder(const std::filesystem::path& folder, const std::filesystem::path& study_file,
                  const std::string& command);

/// The last one that claimed the folder; where there is none, one that goes on with its study.
std::string command_of(const std::filesystem::path& folder);

}  // namespace stillpoint::study
