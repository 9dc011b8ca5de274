// stillpoint run --save-map, --load-map and --localise-only.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "support/absolute_error.hpp"
#include "support/simulated_recording.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class SavedMap : public ::testing::Test {
 protected:
  Outcome run(const std::string& name, const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {"run",       "orb_baseline",
                                          "--dataset", simulated_recording().string(),
                                          "-o",        (out() / name).string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return call(std::move(arguments));
  }
  const fs::path& out() const { return folder_.path(); }

  TemporaryFolder folder_;
  const fs::path map_ = folder_.path() / "maps/office.map";
};

TEST_F(SavedMap, IsFoundAgainAndStaysAsItIs) {
  const Outcome saved = run("first", {"--save-map", map_.string()});
  ASSERT_EQ(saved.exit_code, 0) << saved.err;
  const std::string bytes = text_of(map_);
  const Outcome localised = run("again", {"--load-map", map_.string(), "--localise-only",
                                          "--save-map", (out() / "after.map").string()});
  ASSERT_EQ(localised.exit_code, 0) << localised.err;
  EXPECT_EQ(json_file(out() / "again/summary.json")["coverage"], 1.0);
  EXPECT_LT(absolute_error(simulated_recording(), out() / "again/trajectory.txt"), 0.006);
  EXPECT_EQ(text_of(map_), bytes);
  EXPECT_EQ(text_of(out() / "after.map"), bytes) << "nothing was added to it";
}

TEST_F(SavedMap, GrowsWhenItMay) {
  ASSERT_EQ(run("first", {"--save-map", map_.string()}).exit_code, 0);
  const Outcome outcome = run("again", {"--load-map", map_.string()});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(json_file(out() / "again/summary.json")["coverage"], 1.0);
}

TEST_F(SavedMap, AnUnusableOneIsRefusedBeforeTheRun) {
  fs::create_directories(map_.parent_path());
  std::ofstream(map_) << "a shopping list";
  const Outcome foreign = run("foreign", {"--load-map", map_.string()});
  EXPECT_EQ(foreign.exit_code, 3);
  EXPECT_THAT(foreign.err, HasSubstr(map_.string()));
  EXPECT_FALSE(fs::exists(out() / "foreign"));
  const Outcome missing = run("missing", {"--load-map", (out() / "no.map").string()});
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_THAT(missing.err, HasSubstr("there is no such file"));
  const Outcome unwritable = run("unwritable", {"--save-map", "/proc/no.map"});
  EXPECT_EQ(unwritable.exit_code, 2);
  EXPECT_THAT(unwritable.err, HasSubstr("/proc/no.map: cannot write"));
  EXPECT_FALSE(fs::exists(out() / "unwritable"));
  EXPECT_EQ(run("alone", {"--localise-only"}).exit_code, 2);
}

}  // namespace
}  // namespace stillpoint::testing
