#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/program.hpp"

namespace stillpoint::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// `stillpoint simulate` with a scene of this text: refused, and nothing written.
class SceneFileTest : public ::testing::Test {
 protected:
  Outcome simulate(const std::string& text) {
    const std::filesystem::path scene = folder_.path() / "scene.yaml";
    std::ofstream(scene) << text;
    return simulate_file(scene.string());
  }
  Outcome simulate_file(const std::string& scene, std::vector<std::string> more = {}) {
    const std::filesystem::path output = folder_.path() / "recording";
    std::vector<std::string> arguments = {"simulate", scene, "-o", output.string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = call(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(output));
    return outcome;
  }

  TemporaryFolder folder_;
};

TEST_F(SceneFileTest, EveryFaultIsNamedWithItsPlace) {
  const Outcome outcome = simulate(
      "version: 1\n"
      "source: {type: simulation, frmaes: 3, motion: {kind: zyx}}\n"
      "tracker: {}\n");
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("scene.yaml:2:28: error: source: unknown key 'frmaes'; did you mean "
                              "'frames'?"),
                    HasSubstr("scene.yaml:2:54: error: source.motion.kind = zyx is not one of"),
                    HasSubstr("scene.yaml:3:1: error: unknown section 'tracker'")));
}

TEST_F(SceneFileTest, WhatIsNoYamlIsRefused) {
  EXPECT_THAT(simulate("source: {type: simulation\n").err, HasSubstr("not valid YAML"));
}

TEST_F(SceneFileTest, ImpossibleScenesAreRefused) {
  EXPECT_THAT(simulate("version: 1\nsource: {people: [{path: [1, 2, 3]}]}\n").err,
              HasSubstr("path takes pairs x, y"));
  EXPECT_THAT(simulate("version: 1\nsource: {sensor: {exposure: 3}}\n").err,
              HasSubstr("source.sensor.exposure = 3"));
  // Beyond what a float of the ray caster can be.
  for (const char* place :
       {"motion: {position: [1e300, 0, 1]}", "motion: {look_at: [0, -1e300, 1]}",
        "people: [{path: [1, 1e39]}]", "balls: [{from: [1, 2, 1e300]}]"})
    EXPECT_THAT(simulate(std::string("version: 1\nsource: {") + place + "}\n").err,
                HasSubstr("is outside [-1000, 1000]"));
}

TEST_F(SceneFileTest, UnknownScenesAreAnsweredWithThoseThereAre) {
  EXPECT_THAT(simulate_file("fr3_wlaking_xyz").err,
              AllOf(HasSubstr("no scene named 'fr3_wlaking_xyz'"), HasSubstr("fr3_walking_xyz,")));
}

TEST_F(SceneFileTest, SettingsOfTheCommandLineAreCheckedToo) {
  EXPECT_THAT(simulate_file("fr3_walking_xyz", {"--set", "source.frames=many"}).err,
              HasSubstr("--set source.frames=many"));
}

}  // namespace
}  // namespace stillpoint::testing
