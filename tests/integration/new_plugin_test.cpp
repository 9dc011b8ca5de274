// stillpoint plugins new: what it writes, and what it refuses. tests/install builds the projects.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "support/program.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr int kRefused = 2;

class NewPlugin : public ::testing::Test {
 protected:
  Outcome make(const std::string& kind, const std::string& name,
               const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"plugins", "new", kind, name};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return call(arguments, {.folder = folder_.path()});
  }
  void expect_refused(const Outcome& outcome, const std::string& message) const {
    EXPECT_EQ(outcome.exit_code, kRefused) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("error: "));
    EXPECT_THAT(outcome.err, HasSubstr(message));
    EXPECT_EQ(outcome.out, "");
  }
  std::set<std::string> names_in(const fs::path& folder) const {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_.path() / folder))
      names.insert(entry.path().filename().string());
    return names;
  }

  const TemporaryFolder folder_;
};

TEST_F(NewPlugin, EveryKindHasAProjectWithTheNamePutIn) {
  std::set<std::string> kinds;
  for (const auto& entry :
       fs::directory_iterator(fs::path(STILLPOINT_SOURCE_DIR) / "sdk/templates"))
    kinds.insert(entry.path().filename().string());
  kinds.erase("common");
  EXPECT_EQ(kinds.size(), 11u);
  for (const std::string& kind : kinds) {
    const std::string name = "new_" + kind;
    const Outcome made = make(kind, name);
    ASSERT_EQ(made.exit_code, 0) << made.err;
    EXPECT_EQ(names_in(name),
              (std::set<std::string>{".gitignore", "CMakeLists.txt", "README.md", name + ".cpp",
                                     name + ".hpp", name + "_test.cpp", "pipeline.yaml"}));
    for (const std::string& file : names_in(name)) {
      const std::string text = text_of(folder_.path() / name / file);
      EXPECT_NE(text, "") << file;
      for (const char* left : {"my_plugin", "MyPlugin", "@kind@", "@about@", "@run@", "@version@"})
        EXPECT_THAT(text, Not(HasSubstr(left))) << kind << ' ' << file;
      EXPECT_THAT(made.out, HasSubstr(file));
    }
    EXPECT_THAT(text_of(folder_.path() / name / (name + ".cpp")),
                HasSubstr("STILLPOINT_PLUGIN(new_"));
  }
}

TEST_F(NewPlugin, TheNameMayBePartOfATemplatesName) {
  ASSERT_EQ(make("output", "my_plugin_2").exit_code, 0);
  EXPECT_THAT(text_of(folder_.path() / "my_plugin_2/my_plugin_2.hpp"),
              HasSubstr("class MyPlugin2 final"));
}

TEST_F(NewPlugin, UnknownKinds) {
  expect_refused(make("moving_cheker", "mine"), "did you mean 'moving_checker'?");
  expect_refused(make("common", "mine"), "available: source, segmenter, propagator");
  expect_refused(make("", "mine"), "there is no kind of plugin ''");
  expect_refused(make("../decision", "mine"), "there is no kind of plugin");
  expect_refused(call({"plugins", "new", "tracker"}), "name is required");
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

TEST_F(NewPlugin, NamesThatCannotBe) {
  for (const char* name : {"", "2nd", "MyCheck", "my-check", "my check", "_mine", "mine_",
                           "my__one", "../mine", "m\u00fcde", "mine;"})
    expect_refused(make("tracker", name),
                   "cannot be the name of a plugin; take lower-case letters");
  for (const char* name : {"class", "not_eq", "std", "plugin", "test", "options"})
    expect_refused(make("tracker", name), "take another one, as in my_");
  expect_refused(make("tracker", std::string(65, 'a')), "has 65 characters; take at most 64");
  EXPECT_EQ(make("tracker", std::string(64, 'a')).exit_code, 0);
  EXPECT_EQ(make("tracker", "tester").exit_code, 0);
  expect_refused(make("tracker", "orb"), "'orb' is already a type of tracker, in ");
  EXPECT_EQ(make("segmenter", "orb").exit_code, 0);
}

TEST_F(NewPlugin, FoldersThatAreTaken) {
  folder_.write("mine/notes.txt", "keep me");
  expect_refused(make("tracker", "mine"), "mine: there is something in this folder already");
  EXPECT_EQ(names_in("mine"), std::set<std::string>{"notes.txt"});
  expect_refused(make("tracker", "mine", {"-o", "mine/notes.txt"}), "is not a folder");
  expect_refused(make("tracker", "mine", {"-o", "mine/notes.txt/deeper"}), "mine/notes.txt");
  EXPECT_EQ(text_of(folder_.path() / "mine/notes.txt"), "keep me");

  fs::create_directory(folder_.path() / "empty");
  EXPECT_EQ(make("tracker", "mine", {"-o", "empty"}).exit_code, 0);
  EXPECT_EQ(make("tracker", "mine", {"-o", "a/b/c"}).exit_code, 0);
  EXPECT_TRUE(fs::exists(folder_.path() / "a/b/c/mine.cpp"));
}

TEST_F(NewPlugin, NothingIsLeftOfWhatCannotBeWritten) {
  // The folder's path is as long as the system allows, those of some files in it are too long.
  constexpr std::size_t kMaxPath = 4095;
  std::string deep = "made";
  while (deep.size() + 200 < kMaxPath) deep += "/" + std::string(150, 'x');
  deep += "/" + std::string(kMaxPath - deep.size() - 1 -
                                std::string("/CMakeLists.txt.4194304-0.part").size(),
                            'y');
  const Outcome outcome = make("tracker", "a_plugin_with_a_long_name", {"-o", deep});
  expect_refused(outcome, ": cannot write: File name too long");
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

}  // namespace
}  // namespace stillpoint::testing
