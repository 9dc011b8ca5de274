// The dense map of a run: there, whole, and the same again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "support/simulated_recording.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;

class DenseMap : public ::testing::Test {
 protected:
  fs::path run(const std::string& name, const std::string& mode) const {
    const Outcome outcome = call({"run", "stillpoint", "--dataset", simulated_recording().string(),
                                  "-o", (folder_.path() / name).string(), "--set",
                                  "map_backend.type=octomap", "--set", "runtime.mode=" + mode});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return folder_.path() / name / "map";
  }

  TemporaryFolder folder_;
};
class DenseMapInBothModes : public DenseMap, public ::testing::WithParamInterface<const char*> {};
INSTANTIATE_TEST_SUITE_P(Modes, DenseMapInBothModes, ::testing::Values("inline", "threaded"),
                         [](const auto& mode) { return std::string(mode.param); });

std::string bytes_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST_P(DenseMapInBothModes, IsWrittenInAllForms) {
  const fs::path map = run("run", GetParam());
  EXPECT_THAT(bytes_of(map / "map.ot"), ::testing::HasSubstr("id ColorOcTree"));
  EXPECT_THAT(bytes_of(map / "map.ot"), ::testing::HasSubstr("# stillpoint classes 1\n"));
  EXPECT_THAT(bytes_of(map / "map.bt"), ::testing::HasSubstr("# Octomap OcTree binary file"));
  EXPECT_THAT(bytes_of(map / "map.ply"), ::testing::HasSubstr("property uchar label"));
  EXPECT_GT(fs::file_size(map / "map.ply"), 16U * 2000U);  // voxels
}

TEST_F(DenseMap, IsTheSameAgainInline) {
  const fs::path one = run("one", "inline"), other = run("other", "inline");
  for (const char* file : {"map.ot", "map.bt", "map.ply"})
    EXPECT_EQ(bytes_of(one / file), bytes_of(other / file)) << file;
}

}  // namespace
}  // namespace stillpoint::testing
