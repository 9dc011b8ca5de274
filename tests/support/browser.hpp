// Pages in headless Chromium.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

#include "support/recording_writer.hpp"

namespace stillpoint::testing {

/// Empty where there is none.
inline std::filesystem::path browser() {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    for (const char* name : {"chromium", "chromium-browser", "google-chrome"})
      if (std::filesystem::exists(std::filesystem::path(folder) / name))
        return std::filesystem::path(folder) / name;
  return {};
}

/// The document once the JavaScript expression holds, which is asked again and again and may click.
/// Errors of the page's scripts fail the test.
inline std::string document_in_browser(const std::string& url, const std::string& condition) {
  const auto text_of_file = [](const std::filesystem::path& file) {
    std::ifstream stream(file);
    return std::string(std::istreambuf_iterator<char>(stream), {});
  };
  const TemporaryFolder folder;
  const auto dom = folder.path() / "dom", log = folder.path() / "log";
  const std::string command = "python3 '" STILLPOINT_SOURCE_DIR "/tests/support/browser.py' '" +
                              browser().string() + "' '" + url + "' \"$(cat '" +
                              folder.write("condition.js", condition).string() + "')\" > '" +
                              dom.string() + "' 2> '" + log.string() + "'";
  EXPECT_EQ(std::system(command.c_str()), 0);
  EXPECT_EQ(text_of_file(log), "");
  return text_of_file(dom);
}

}  // namespace stillpoint::testing

#define SKIP_WITHOUT_BROWSER()                \
  if (stillpoint::testing::browser().empty()) \
  GTEST_SKIP() << "no chromium in PATH: apt-get install chromium"
