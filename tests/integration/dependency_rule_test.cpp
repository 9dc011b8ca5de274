// Who may include whom: options ← contracts ← plugin ← engine ← runtime ← tools; libraries know the
// SDK; plugins and tools know the SDK and libraries, and never each other's inside.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace stillpoint {
namespace {

namespace fs = std::filesystem;

const fs::path kRoot = STILLPOINT_SOURCE_DIR;
const fs::path kPublic = kRoot / "core/include/stillpoint";

struct Include {
  fs::path by;
  std::string header;
};

bool is_source(const fs::path& file) {
  return file.extension() == ".hpp" || file.extension() == ".cpp";
}

std::vector<Include> includes_of(const fs::path& file) {
  static const std::regex kIncludeLine(R"(\s*#\s*include\s*["<]([^">]+)[">].*)");
  std::vector<Include> result;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    std::smatch match;
    if (std::regex_match(line, match, kIncludeLine)) result.push_back({file, match[1]});
  }
  return result;
}

// Of a file, or of all files below a folder.
std::vector<Include> includes_below(const fs::path& path) {
  if (!fs::is_directory(path)) return includes_of(path);
  std::vector<Include> result;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(path)) {
    if (!entry.is_regular_file() || !is_source(entry.path())) continue;
    for (const Include& include : includes_of(entry.path())) result.push_back(include);
  }
  return result;
}

std::set<std::string> folders_in(const fs::path& path) {
  std::set<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(path))
    if (entry.is_directory()) names.insert(entry.path().filename());
  return names;
}

void expect_none_begins(const fs::path& path, const std::vector<std::string>& forbidden) {
  ASSERT_TRUE(fs::exists(path)) << path;
  for (const Include& include : includes_below(path))
    for (const std::string& prefix : forbidden)
      EXPECT_FALSE(include.header.starts_with(prefix))
          << fs::relative(include.by, kRoot).string() << " includes " << include.header;
}

// "evaluation/", "orb_slam/", …: the first part of a header that belongs to a tool or a plugin.
std::vector<std::string> prefixes_of(const fs::path& parent) {
  std::vector<std::string> prefixes;
  for (const std::string& folder : folders_in(parent))
    if (folder != "stillpoint") prefixes.push_back(folder + "/");  // the program has no headers
  return prefixes;
}

// A camera is both part of a frame and a section of a pipeline file: options lie below contracts.
TEST(DependencyRule, OptionsKnowNothingAndContractsOnlyThem) {
  expect_none_begins(kPublic / "options.hpp", {"stillpoint/contracts", "stillpoint/plugin"});
  for (const fs::path& folder : {kPublic / "contracts", kRoot / "core/src/contracts"})
    expect_none_begins(folder, {"stillpoint/plugin", "stillpoint/sdk", "stillpoint/support",
                                "stillpoint/engine", "stillpoint/runtime", "stillpoint/testing"});
}

TEST(DependencyRule, WhatIsPromisedDoesWithoutHelpers) {
  for (const fs::directory_entry& entry : fs::directory_iterator(kPublic))
    if (entry.is_regular_file())
      expect_none_begins(entry.path(), {"stillpoint/support", "stillpoint/engine",
                                        "stillpoint/runtime", "stillpoint/testing"});
}

TEST(DependencyRule, HelpersDoNotKnowTheEngine) {
  for (const fs::path& folder : {kPublic / "support", kRoot / "core/src/support"})
    expect_none_begins(folder, {"stillpoint/engine", "stillpoint/runtime", "stillpoint/testing"});
}

TEST(DependencyRule, WhatTestsOfPluginsLinkDoesNotKnowTheEngine) {
  for (const fs::path& folder : {kPublic / "testing", kRoot / "core/src/testing"})
    expect_none_begins(folder, {"stillpoint/engine", "stillpoint/runtime"});
}

TEST(DependencyRule, TheLibraryOfTheSdkDoesNotKnowTheEngine) {
  const std::vector<std::string> above = {"stillpoint/engine", "stillpoint/runtime",
                                          "stillpoint/testing"};
  expect_none_begins(kRoot / "core/src/image_codec", above);
  for (const fs::directory_entry& entry : fs::directory_iterator(kRoot / "core/src"))
    if (is_source(entry.path())) expect_none_begins(entry.path(), above);
}

// The runtime's headers are not installed.
TEST(DependencyRule, TheEngineIsUsedWithoutTheRuntime) {
  for (const fs::path& folder : {kPublic / "engine", kRoot / "sdk"})
    expect_none_begins(folder, {"stillpoint/runtime"});
}

TEST(DependencyRule, CoreKnowsNeitherToolsNorPlugins) {
  expect_none_begins(kRoot / "core", prefixes_of(kRoot / "tools"));
  expect_none_begins(kRoot / "core", prefixes_of(kRoot / "plugins"));
}

TEST(DependencyRule, LibrariesKnowTheSdkAndTheRestOfTheCoreNoLibraries) {
  const fs::path libraries = kRoot / "core/libraries";
  ASSERT_FALSE(folders_in(libraries).empty());
  for (const std::string& library : folders_in(libraries)) {
    std::vector<std::string> forbidden = {"stillpoint/engine", "stillpoint/runtime"};
    for (const std::string& prefix : prefixes_of(libraries))
      if (prefix != library + "/") forbidden.push_back(prefix);
    expect_none_begins(libraries / library, forbidden);
  }
  for (const fs::path& folder : {kRoot / "core/include", kRoot / "core/src"})
    expect_none_begins(folder, prefixes_of(libraries));
}

TEST(DependencyRule, PluginsKnowTheSdkAndNotEachOther) {
  for (const std::string& plugin : folders_in(kRoot / "plugins")) {
    std::vector<std::string> forbidden = prefixes_of(kRoot / "tools");
    forbidden.insert(forbidden.end(), {"stillpoint/engine", "stillpoint/runtime"});
    for (const std::string& prefix : prefixes_of(kRoot / "plugins"))
      if (prefix != plugin + "/") forbidden.push_back(prefix);
    expect_none_begins(kRoot / "plugins" / plugin, forbidden);
  }
}

// What is built against the installed package has nothing else; the Python module also evaluates.
TEST(DependencyRule, TheSdkKnowsWhatIsInstalled) {
  for (const std::string& folder : folders_in(kRoot / "sdk")) {
    std::vector<std::string> forbidden = prefixes_of(kRoot / "tools");
    if (folder == "python") std::erase(forbidden, "evaluation/");
    for (const char* parent : {"plugins", "core/libraries"})
      for (const std::string& prefix : prefixes_of(kRoot / parent)) forbidden.push_back(prefix);
    expect_none_begins(kRoot / "sdk" / folder, forbidden);
  }
}

// A path upwards would go round the rules above. Within core/src there are two such folders, of
// parts that are not in the libraries.
TEST(DependencyRule, HeadersAreNamedFromTheirRoot) {
  for (const char* folder : {"core/include", "core/libraries", "plugins", "tools", "sdk", "tests"})
    expect_none_begins(kRoot / folder, {"../"});
}

TEST(DependencyRule, ToolsDoNotKnowPlugins) {
  expect_none_begins(kRoot / "tools", prefixes_of(kRoot / "plugins"));
}

// A program of one's own can do what `run` and `record` do. Studies, scenes and lists of plugins
// read YAML and registries.
TEST(DependencyRule, TheProgramIsAClientOfTheEngine) {
  const std::set<std::string> others = {"plugins",    "scene_file", "study_check",
                                        "study_file", "study_grid", "study_plan"};
  for (const fs::directory_entry& entry : fs::directory_iterator(kRoot / "tools/stillpoint"))
    if (is_source(entry.path()) && !others.contains(entry.path().stem()))
      expect_none_begins(entry.path(), {"stillpoint/runtime"});
}

TEST(DependencyRule, LibrariesOfTheToolsDoNotKnowTheRuntime) {
  for (const std::string& tool : folders_in(kRoot / "tools"))
    if (tool != "stillpoint" && tool != "plugin_check")  // which makes the runtime's checks
      expect_none_begins(kRoot / "tools" / tool, {"stillpoint/engine", "stillpoint/runtime"});
}

// "stillpoint::orb_slam" of "namespace stillpoint::orb_slam {", of all such lines of a file.
std::set<std::string> namespaces_in(const fs::path& file) {
  static const std::regex kBegin(R"(namespace (stillpoint[a-z0-9_:]*) \{.*)");
  std::set<std::string> names;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    std::smatch match;
    if (std::regex_match(line, match, kBegin)) names.insert(match[1]);
  }
  return names;
}

TEST(DependencyRule, NamespacesAreThoseOfTheirFolders) {
  for (const char* parent : {"plugins", "core/libraries", "tools"})
    for (const std::string& folder : folders_in(kRoot / parent)) {
      const std::string name = folder == "stillpoint" ? folder : "stillpoint::" + folder;
      for (const fs::directory_entry& entry : fs::directory_iterator(kRoot / parent / folder)) {
        if (!is_source(entry.path())) continue;
        std::set<std::string> found = namespaces_in(entry.path());
        found.erase("stillpoint::testing");
        EXPECT_TRUE(found.empty() || found == std::set{name}) << entry.path();
        if (entry.path().extension() == ".hpp") {
          EXPECT_FALSE(found.empty()) << entry.path();
        }
      }
    }
}

/// `allowed` and no other, in all files below the folder.
void expect_namespaces(const fs::path& folder, const std::set<std::string>& allowed) {
  ASSERT_TRUE(fs::exists(folder)) << folder;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    if (!is_source(entry.path())) continue;
    for (const std::string& name : namespaces_in(entry.path()))
      EXPECT_TRUE(allowed.contains(name)) << entry.path() << " has " << name;
  }
}

TEST(DependencyRule, CoreHasOneNamespaceAndTestsThoseOfWhatTheyTest) {
  const std::set<std::string> core = {"stillpoint", "stillpoint::testing"};
  for (const char* folder : {"core/include", "core/src"}) expect_namespaces(kRoot / folder, core);
  std::set<std::string> tested = core;
  for (const char* parent : {"plugins", "core/libraries", "tools"})
    for (const std::string& folder : folders_in(kRoot / parent))
      tested.insert("stillpoint::" + folder);
  expect_namespaces(kRoot / "tests", tested);
  expect_namespaces(kRoot / "sdk/python", {"stillpoint::python"});
  expect_namespaces(kRoot / "sdk/ros1", {"stillpoint_ros", "stillpoint"});  // and what it declares
  for (const char* folder : {"sdk/templates", "sdk/examples"})
    expect_namespaces(kRoot / folder, {});
}

}  // namespace
}  // namespace stillpoint
