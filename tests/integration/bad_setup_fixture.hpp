// Runs of the program that cannot begin, and plugins that are wrong.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "support/plugin_libraries.hpp"
#include "support/simulated_recording.hpp"

namespace stillpoint::testing {

class BadSetup : public ::testing::Test {
 protected:
  static constexpr int kStageFailed = 1;
  static constexpr int kWrongUsage = 2;

  std::vector<std::string> command(const std::string& pipeline,
                                   std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(),
                     {"run", pipeline, "-o", out().string(), "--set", "source.limit=6"});
    return arguments;
  }
  Outcome run(const std::string& pipeline, std::vector<std::string> arguments,
              const Surroundings& surroundings = {}) const {
    return call(command(pipeline, std::move(arguments)), surroundings);
  }
  static std::vector<std::string> on_recording(std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"--dataset", simulated_recording().string()});
    return more;
  }
  static void expect_refused(const Outcome& outcome, const std::string& message) {
    EXPECT_EQ(outcome.exit_code, kWrongUsage) << outcome.err;
    EXPECT_THAT(outcome.err, ::testing::HasSubstr("error: "));
    EXPECT_THAT(outcome.err, ::testing::HasSubstr(message));
    EXPECT_EQ(outcome.out, "");
  }
  std::filesystem::path out() const { return folder_.path() / "out"; }

  const TemporaryFolder folder_;
};

/// Every bad plugin in one folder: each gives its own message and the good ones are still there.
class BadPlugins : public BadSetup {
 protected:
  BadPlugins() {
    for (const auto& file : std::filesystem::directory_iterator(kBadPlugins))
      if (file.is_regular_file())
        std::filesystem::copy_file(file.path(), folder_.path() / file.path().filename());
    folder_.write("libstillpoint_text.so", "this is a letter, not a library\n");
    std::filesystem::copy_file(kBadPlugins / "libstillpoint_good.so", truncated());
    truncate_file(truncated(), 0.5);
  }
  std::filesystem::path truncated() const { return folder_.path() / "libstillpoint_truncated.so"; }
  Surroundings with_plugins() const {
    return {.environment = {{"STILLPOINT_PLUGIN_PATH", folder_.path().string()}}};
  }
};

}  // namespace stillpoint::testing
