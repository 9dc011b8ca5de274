// Every cases/NAME.yaml gives the messages in cases/NAME.txt. A first line `# args: …` is its
// command line. STILLPOINT_UPDATE_GOLDEN=1 rewrites the texts, to be reviewed before committing.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "fake_stages.hpp"
#include "stillpoint/engine/pipeline_config.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;

const fs::path kCases = fs::path(STILLPOINT_SOURCE_DIR) / "tests/config_messages/cases";

std::string read(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

PipelineRequest request_of(const std::string& file) {
  PipelineRequest request{.pipeline = file, .plugin_folders = {}};
  std::string first_line, word, value;
  std::ifstream stream(file);
  std::getline(stream, first_line);
  std::istringstream words(first_line);
  words >> word >> word;
  if (word != "args:") return request;
  while (words >> word >> value) {
    if (word == "--set") request.assignments.push_back(value);
    if (word == "--dataset") request.dataset = value;
    if (word == "--camera") request.camera = value;
  }
  return request;
}

std::string messages_of(const std::string& file) {
  try {
    Registry registry;
    registry.add(kFakePlugin);
    load_pipeline(request_of(file), registry);
    return "no faults\n";
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code(), 2);
    std::string text = std::string(error.what()) + "\n";
    const std::string here = fs::current_path().string() + "/";
    for (auto at = text.find(here); at != std::string::npos; at = text.find(here))
      text.erase(at, here.size());
    return text;
  }
}

std::vector<std::string> case_names() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(kCases))
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem());
  std::ranges::sort(names);
  return names;
}

class ConfigMessages : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    fs::current_path(kCases);
    setenv("STILLPOINT_CONFIG_PATH", kCases.c_str(), 1);
    setenv("STILLPOINT_TEST_EPSILON", "wide", 1);
    unsetenv("STILLPOINT_TEST_UNSET");
  }
  void TearDown() override {
    unsetenv("STILLPOINT_CONFIG_PATH");
    fs::current_path("/");
  }
};

TEST_P(ConfigMessages, AreAsRecorded) {
  const std::string messages = messages_of(GetParam() + ".yaml");
  const fs::path expected = kCases / (GetParam() + ".txt");
  if (std::getenv("STILLPOINT_UPDATE_GOLDEN")) std::ofstream(expected) << messages;
  EXPECT_EQ(messages, read(expected));
}

INSTANTIATE_TEST_SUITE_P(Cases, ConfigMessages, testing::ValuesIn(case_names()),
                         [](const auto& instance) { return instance.param; });

}  // namespace
}  // namespace stillpoint
