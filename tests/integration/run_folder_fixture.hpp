// Runs of the program into one folder.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "support/simulated_recording.hpp"

namespace stillpoint::testing {

class RunIntoFolder : public ::testing::Test {
 protected:
  // With these arguments after the pipeline; the run folder is `out` and the name.
  Outcome run(const std::string& name, const std::string& pipeline,
              std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"run", pipeline, "-o", (out() / name).string()});
    return call(std::move(arguments));
  }
  const std::filesystem::path& out() const { return folder_.path(); }

 private:
  TemporaryFolder folder_;
};

}  // namespace stillpoint::testing
