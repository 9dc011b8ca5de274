// The studies that come along, as far as they can be read without being run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "support/program.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

std::vector<fs::path> shipped_studies() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(STILLPOINT_SOURCE_DIR "/configs/studies"))
    if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

/// Folders that look like the recordings that a study takes from `variable`.
void imitate_recordings(const std::string& study, const std::string& variable,
                        const TemporaryFolder& folder) {
  const std::regex used("\\$\\{" + variable + "\\}/(\\w+)");
  for (std::sregex_iterator use(study.begin(), study.end(), used), end; use != end; ++use)
    folder.write((*use)[1].str() + "/groundtruth.txt", "");
}

TEST(ShippedStudies, HaveNoFaults) {
  const TemporaryFolder folder;
  Surroundings surroundings;
  for (const char* variable : {"TUM", "STILLPOINT_REAL_PEOPLE"})
    surroundings.environment[variable] = folder.path().string();
  // All is checked before the folder of the results is made, which cannot be: there is a file.
  const std::string no_folder = folder.write("file", "").string();
  for (const fs::path& study : shipped_studies()) {
    for (const auto& [variable, value] : surroundings.environment)
      imitate_recordings(text_of(study), variable, folder);
    const Outcome outcome = call({"ablate", study.stem().string(), "-o", no_folder}, surroundings);
    EXPECT_THAT(outcome.err, HasSubstr("cannot make the folder")) << study;
  }
}

TEST(ShippedStudies, AreListedWithQuestionAndNumberOfRuns) {
  const Outcome outcome = call({"ablate", "--list"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  std::istringstream lines(outcome.out);
  std::string line;
  std::getline(lines, line);
  EXPECT_THAT(line, ::testing::MatchesRegex("study +runs  question"));
  for (const fs::path& study : shipped_studies()) {
    std::getline(lines, line);
    EXPECT_THAT(line, ::testing::MatchesRegex(study.stem().string() + " +[1-9][0-9]*  .+"));
    // Its file may say so, too.
    const std::string text = text_of(study);
    if (std::smatch said; std::regex_search(text, said, std::regex("([0-9]+) runs"))) {
      EXPECT_THAT(line, HasSubstr(" " + said[1].str() + "  ")) << study;
    }
  }
  EXPECT_FALSE(std::getline(lines, line)) << line;
  EXPECT_THAT(outcome.out, ::testing::ContainsRegex("\nquick +12  What do people cost"));
}

/// What is in the file and in the one that it extends.
std::string extended_text_of(const fs::path& study) {
  const std::string text = text_of(study);
  static const std::regex kExtends("\nextends: (\\w+)\n");
  std::smatch base;
  if (!std::regex_search(text, base, kExtends)) return text;
  return text + extended_text_of(study.parent_path() / (base[1].str() + ".yaml"));
}

TEST(ShippedStudies, EndRunsThatHang) {
  for (const fs::path& study : shipped_studies())
    EXPECT_THAT(extended_text_of(study), ::testing::ContainsRegex("\ntime_limit: [1-9][0-9]+ "))
        << study;
}

TEST(ShippedStudies, AreListedBesideOnesThatCannotBeRead) {
  const TemporaryFolder configs;
  configs.write("studies/mine.yaml", "version: 1\nsequencs: []\n");
  const Outcome outcome = call(
      {"ablate", "--list"}, {.environment = {{"STILLPOINT_CONFIG_PATH", configs.path().string()}}});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.out, HasSubstr("unknown key 'sequencs'"));
}

}  // namespace
}  // namespace stillpoint::testing
