// The dense map of a run: there, whole, and the same again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/image_io.hpp"
#include "support/simulated_recording.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;

class DenseMap : public ::testing::Test {
 protected:
  fs::path run(const std::string& name, const std::string& mode) const {
    const Outcome outcome =
        call({"run", "stillpoint", "--dataset", simulated_recording().string(), "-o",
              (folder_.path() / name).string(), "--set", "runtime.mode=" + mode});
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
  EXPECT_THAT(bytes_of(map / "map.pgm"), ::testing::StartsWith("P5\n"));
  EXPECT_THAT(bytes_of(map / "map.yaml"), ::testing::HasSubstr("image: \"map.pgm\"\n"));
}

TEST_F(DenseMap, IsTheSameAgainInline) {
  const fs::path one = run("one", "inline"), other = run("other", "inline");
  for (const char* file : {"map.ot", "map.bt", "map.ply", "map.pgm", "map.yaml"})
    EXPECT_EQ(bytes_of(one / file), bytes_of(other / file)) << file;
}

TEST_F(DenseMap, ThatCannotBeWrittenTakesNothingElseWithIt) {
  const fs::path out = folder_.path() / "out";
  fs::create_directories(out);
  std::ofstream(out / "map") << "in the way";
  const Outcome outcome =
      call({"run", "stillpoint", "--dataset", simulated_recording().string(), "-o", out.string()});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, ::testing::HasSubstr((out / "map").string() + ": cannot be made"));
  EXPECT_GT(fs::file_size(out / "trajectory.txt"), 1000U);
  EXPECT_GT(fs::file_size(out / "summary.json"), 100U);
}

class MapCommands : public DenseMap {
 protected:
  static void SetUpTestSuite() {
    folder_of_map_ = new TemporaryFolder;
    const Outcome outcome = call({"run", "stillpoint", "--dataset", simulated_recording().string(),
                                  "-o", folder_of_map_->path().string()});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }
  static void TearDownTestSuite() { delete folder_of_map_; }

  static std::string file(const char* name) {
    return (folder_of_map_->path() / "map" / name).string();
  }
  std::string new_file(const char* name) const { return (folder_.path() / name).string(); }
  static Outcome map(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "map");
    return call(arguments);
  }

  static inline TemporaryFolder* folder_of_map_ = nullptr;
};

TEST_F(MapCommands, InfoSaysWhatItHolds) {
  const Outcome table = map({"info", file("map.ot")});
  EXPECT_EQ(table.exit_code, 0) << table.err;
  EXPECT_THAT(table.out, ::testing::HasSubstr("5 cm, colours and classes"));
  EXPECT_THAT(table.out, ::testing::HasSubstr("below the origin"));
  const auto json = nlohmann::json::parse(map({"info", "--json", file("map.ot")}).out);
  EXPECT_GT(json["occupied_voxels"], 2000);
  // The simulated camera is 1.0 to 1.6 m above the floor.
  EXPECT_NEAR(json["floor"]["height_m"].get<double>(), -1.3, 0.4);
}

TEST_F(MapCommands, ConvertMakesTheFilesThatTheRunMade) {
  for (const char* name : {"map.ot", "map.bt", "map.ply"}) {
    const Outcome outcome = map({"convert", file("map.ot"), "-o", new_file(name)});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(bytes_of(new_file(name)), bytes_of(file(name))) << name;
  }
}

TEST_F(MapCommands, ProjectMakesTheCostMapThatTheRunMade) {
  const Outcome outcome = map({"project", file("map.ot"), "-o", new_file("map")});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* name : {"map.pgm", "map.yaml"})
    EXPECT_EQ(bytes_of(new_file(name)), bytes_of(file(name))) << name;
}

TEST_F(MapCommands, DiffOfAMapWithItselfIsNone) {
  const Outcome outcome = map({"diff", file("map.ot"), file("map.bt"), "--ply", new_file("d.ply")});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, ::testing::HasSubstr("100.00 % of all occupied ones"));
  EXPECT_THAT(bytes_of(new_file("d.ply")), ::testing::HasSubstr("element vertex 0\n"));
}

TEST_F(MapCommands, RenderDrawsAPicture) {
  const Outcome outcome = map({"render", file("map.ot"), "-o", new_file("map.png"), "--size",
                               "320x200", "--mode", "class", "--azimuth=-40"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const cv::Mat picture = read_image(new_file("map.png"));
  ASSERT_EQ(picture.size(), cv::Size(320, 200));
  EXPECT_GT(
      cv::norm(picture, cv::Mat(picture.size(), picture.type(), cv::Scalar::all(255)), cv::NORM_L1),
      1e5);
}

TEST_F(MapCommands, BadInputIsNamed) {
  const auto expect = [](const Outcome& outcome, int exit_code, const std::string& message) {
    EXPECT_EQ(outcome.exit_code, exit_code) << outcome.err;
    EXPECT_THAT(outcome.err, ::testing::StartsWith("error: "));
    EXPECT_THAT(outcome.err, ::testing::HasSubstr(message));
  };
  const std::string whole = bytes_of(file("map.ot")), half = new_file("half.ot");
  std::ofstream(half, std::ios::binary) << whole.substr(0, whole.size() / 2);
  for (const char* command : {"info", "project"})
    expect(map({command, half}), 3, "half.ot: the file ends within the map");
  expect(map({"info", file("map.ply")}), 3, "is no octree of OctoMap");
  expect(map({"info", new_file("none.ot")}), 3, "none.ot: cannot be read");
  expect(map({"convert", file("map.ot"), "-o", new_file("map.xyz")}), 2,
         "'.xyz' is no kind of map");
  expect(map({"convert", file("map.ot"), "-o", "/proc/map.ply"}), 2, "cannot write");
  expect(map({"project", file("map.ot"), "--from", "2"}), 2, "--from must be lower than --to");
  expect(map({"render", file("map.bt"), "-o", new_file("map.png")}), 2, "the map has no colours");
  expect(map({"render", file("map.ot"), "-o", new_file("map.png"), "--size", "big"}), 2,
         "'big' is no size");
  expect(map({"render", file("map.ot"), "-o", new_file("map.png"), "--eye", "1,2,3"}), 2,
         "--eye and --look-at belong together");
  expect(map({"inof", file("map.ot")}), 2,
         "stillpoint map: no command 'inof'; did you mean 'info'?");
  expect(map({"render", "--eye", "1,2,nan", "--look-at", "0,0,0", file("map.ot"), "-o",
              new_file("map.png")}),
         2, "'1,2,nan' should be numbers");
  expect(map({"render", "--elevation", "nan", file("map.ot"), "-o", new_file("map.png")}), 2,
         "nan");
  expect(map({"render", file("map.ot"), "-o", new_file("map.jpg")}), 2, "pictures are PNG files");
  expect(map({"project", file("map.ot"), "--robot-radius", "nan"}), 2, "nan");
  expect(map({"project", file("map.ot"), "--floor", "0,0,0"}), 2, "'0,0,0' is no direction");
  expect(map({"project", file("map.ot"), "--floor", "0,0"}), 2, "'0,0' should be numbers");
  EXPECT_FALSE(fs::exists(new_file("map.png")));
}

TEST_F(MapCommands, AFloorMayBeGiven) {
  const Outcome outcome =
      map({"project", "--floor", "0,-1,0,-1.2", file("map.ot"), "-o", new_file("map")});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  // On the floor, 1.2 m below the origin; its z axis is the world's -y, its x axis the world's z.
  EXPECT_THAT(bytes_of(new_file("map.yaml")),
              ::testing::ContainsRegex("world_from_map: \\[-?0, 1.2, -?0, -?0.5, "));
  EXPECT_EQ(map({"render", file("map.ot"), "-o", new_file("map.png"), "--floor=0,-1,0,-1.2",
                 "--below=1.5", "--size=320x240"})
                .exit_code,
            0);
}

}  // namespace
}  // namespace stillpoint::testing
