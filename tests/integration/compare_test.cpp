// `stillpoint compare`: several trajectories, in the formats of several systems, against one
// reference.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "support/program.hpp"

namespace stillpoint::testing {
namespace {

using ::testing::HasSubstr;

constexpr const char* kOrigin =
    "\nStillpoint [0-9.]+(, commit [-0-9a-z]+)?; [^;\n]* cores?; 20[0-9]+-[0-9]+-[0-9]+\n$";

/// A camera that goes along x for 3 s, 1 m/s, looking along z; the estimates are `aside` off in y
/// at every second pose.
class Compare : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const char* format, double aside) {
    std::string text;
    for (int i = 0; i < 31; ++i) {
      char line[200];
      const double y = i % 2 == 0 ? aside : 0.0;
      if (std::string(format) == "tum")
        std::snprintf(line, sizeof(line), "%.6f %.3f %.6f %.3f 0 0 0 1\n", 1.5e9 + 0.1 * i, 0.1 * i,
                      y, 0.002 * i * i);
      else if (std::string(format) == "euroc")
        std::snprintf(line, sizeof(line), "%lld,%.3f,%.6f,%.3f,1,0,0,0\n",
                      1'500'000'000'000'000'000LL + 100'000'000LL * i, 0.1 * i, y, 0.002 * i * i);
      else
        std::snprintf(line, sizeof(line), "1 0 0 %.3f 0 1 0 %.6f 0 0 1 %.3f\n", 0.1 * i, y,
                      0.002 * i * i);
      text += line;
    }
    folder_.write(name, text);
    return (folder_.path() / name).string();
  }
  TemporaryFolder folder_;
};

TEST_F(Compare, ReadsTheFormatsOfOthersBesideEachOther) {
  write("recording/groundtruth.txt", "tum", 0.0);
  write("ours/trajectory.txt", "tum", 0.004);
  const std::string theirs = write("theirs.csv", "euroc", 0.02);
  const std::string plot = (folder_.path() / "plot.svg").string();
  const std::string reference = (folder_.path() / "recording").string();
  const std::string ours = (folder_.path() / "ours").string() + "/";
  Outcome outcome = call({"compare", "--reference", reference, ours, theirs, "--plot", plot});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, ::testing::ContainsRegex("ours +100.0 +31 +0.0020[*]"));
  EXPECT_THAT(outcome.out, ::testing::ContainsRegex("theirs +100.0 +[0-9]+ +0.0100 "));
  EXPECT_GT(std::filesystem::file_size(plot), 10'000u);
  EXPECT_THAT(outcome.out,
              ::testing::ContainsRegex("\n\nstillpoint compare --reference " + reference + " " +
                                       ours + " " + theirs + " --plot " + plot + kOrigin));

  outcome = call({"compare", "--reference", reference, "a=" + ours, "b=" + theirs, "--align",
                  "none", "--json"});
  const nlohmann::json json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["runs"][1]["name"], "b");
  EXPECT_NEAR(json["runs"][1]["aligned"]["position_m"]["max"], 0.02, 1e-9);
  EXPECT_THAT(json["made_by"]["command"].get<std::string>(),
              ::testing::StartsWith("stillpoint compare --reference "));
}

TEST_F(Compare, EvaluateTakesTheFoldersOfRecordingAndRun) {
  write("recording/groundtruth.txt", "tum", 0.0);
  write("run/trajectory.txt", "tum", 0.02);
  const Outcome outcome = call({"evaluate", "--reference", (folder_.path() / "recording").string(),
                                "--estimate", (folder_.path() / "run").string(), "--json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json json = nlohmann::json::parse(outcome.out);
  EXPECT_NEAR(json["ate"]["se3_m"]["rmse"], 0.01, 1e-4);
  EXPECT_THAT(json["made_by"]["command"].get<std::string>(),
              ::testing::StartsWith("stillpoint evaluate --reference "));
  for (const char* key : {"version", "machine", "date"}) EXPECT_NE(json["made_by"][key], "") << key;
}

TEST_F(Compare, KittiIsComparedWithKitti) {
  const std::string truth = write("truth.txt", "kitti", 0.0), run = write("run.txt", "kitti", 0.02);
  const Outcome outcome =
      call({"compare", "--reference", truth, run, "--align", "origin", "--json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NEAR(nlohmann::json::parse(outcome.out)["runs"][0]["aligned"]["position_m"]["max"], 0.02,
              1e-9);
}

// A monocular system knows no scale.
TEST_F(Compare, WithSim3TheRelativeErrorIsInMetresOfTheReference) {
  const std::string truth = write("truth.txt", "tum", 0.0);
  std::string small;
  for (int i = 0; i < 31; ++i) {
    char line[200];
    std::snprintf(line, sizeof(line), "%.6f %.6f 0 %.6f 0 0 0 1\n", 1.5e9 + 0.1 * i, 0.01 * i,
                  0.0002 * i * i);
    small += line;
  }
  const std::string run = folder_.write("small.txt", small).string();
  const Outcome outcome = call({"compare", "--reference", truth, run, "--align", "sim3", "--json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json json = nlohmann::json::parse(outcome.out)["runs"][0];
  EXPECT_NEAR(json["aligned"]["scale"], 10.0, 1e-3);
  EXPECT_LT(json["rpe"]["translation_m"]["rmse"], 0.001) << outcome.out;
}

TEST_F(Compare, TheAlignedTrajectoryReplacesNoneThatIsRead) {
  const std::string truth = write("truth.txt", "tum", 0.0), run = write("run.txt", "tum", 0.02);
  for (const std::string& file : {truth, run}) {
    const std::string before = text_of(file);
    const Outcome outcome =
        call({"evaluate", "--reference", truth, "--estimate", run, "--aligned", file});
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("is read by this command, and would be replaced"));
    EXPECT_EQ(text_of(file), before);
  }
}

// Whether the times are those since 1970, or begin with 0 as the counted ones do.
TEST_F(Compare, PosesWithoutTimesHaveNoPartnersAmongThoseWithTimes) {
  const std::string counted = write("counted.txt", "kitti", 0.0);
  const std::string from_zero =
      folder_.write("from_zero.txt", "0 0 0 0 0 0 0 1\n0.1 1 0 0 0 0 0 1\n0.2 1 1 0 0 0 0 1\n");
  for (const std::string& timed : {write("timed.txt", "tum", 0.0), from_zero}) {
    const std::string message =
        counted + ": has no time stamps (the format of KITTI), and " + timed + " has: ";
    for (const auto& [truth, run] : {std::pair(timed, counted), std::pair(counted, timed)}) {
      const Outcome outcome = call({"compare", "--reference", truth, run});
      EXPECT_EQ(outcome.exit_code, 3);
      EXPECT_THAT(outcome.err,
                  ::testing::AllOf(HasSubstr(message), HasSubstr("; write both with times, "),
                                   ::testing::Not(HasSubstr("--offset"))));
    }
  }
}

TEST_F(Compare, TheTableOfOneNamesCommandAndOrigin) {
  const std::string truth = write("truth.txt", "tum", 0.0), run = write("run.txt", "tum", 0.02);
  const Outcome outcome = call({"evaluate", "--reference", truth, "--estimate", run});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, ::testing::ContainsRegex("\n\nstillpoint evaluate --reference " + truth +
                                                    " --estimate " + run + kOrigin));
}

TEST_F(Compare, WhatCannotBeComparedIsNamed) {
  const std::string truth = write("truth.txt", "tum", 0.0);
  const std::string early = folder_.write("early.txt", "1 0 0 0 0 0 0 1\n").string();
  const std::string again = write("again/truth.txt", "tum", 0.0);
  Outcome outcome = call({"compare", "--reference", truth, truth, again});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("two runs are named 'truth'; give them names: NAME="));
  outcome = call({"compare", "--reference", truth, early});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("do not overlap in time"));
  outcome = call({"compare", "--reference", truth, truth, "--plot", "plot.jpg"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("plot.jpg: a figure is a .png, .svg or .pdf file"));
  outcome = call({"compare", "--reference", truth, (folder_.path() / "nothing").string()});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("nothing: no such file"));
  EXPECT_EQ(call({"compare", "--reference", truth, truth, "--align", "best"}).exit_code, 2);
}

}  // namespace
}  // namespace stillpoint::testing
