// `stillpoint import`, as a user calls it.
#include <fstream>
#include <sstream>

#include "importing/fixtures.hpp"
#include "importing/sens_writer.hpp"
#include "support/simulated_recording.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

class Import : public ::testing::Test {
 protected:
  Outcome import(const fs::path& recording, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"import", recording.string(), "-o", out().string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return call(arguments);
  }
  fs::path out() const { return folder_.path() / "out"; }

  const TemporaryFolder folder_;
};

/// Poses as text, without their times.
std::string poses_of(const fs::path& trajectory) {
  std::istringstream lines(text_of(trajectory));
  std::string poses;
  for (std::string line; std::getline(lines, line);)
    if (!line.starts_with("#")) poses += line.substr(line.find(' ')) + '\n';
  return poses;
}

TEST_F(Import, ASimulatedRecordingIn7ScenesFormRunsAsItself) {
  const RecordingCopy original(15);
  const fs::path scene = folder_.path() / "seq-01";
  fs::create_directories(scene);
  for (int i = 0; i < 15; ++i) {
    char stem[32];
    std::snprintf(stem, sizeof(stem), "frame-%06d.", i);
    fs::copy_file(original.color(i), scene / (std::string(stem) + "color.png"));
    fs::copy_file(original.depth(i), scene / (std::string(stem) + "depth.png"));
  }
  const Outcome outcome = import(scene, {"--camera", (original.path() / "camera.yaml").string()});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(
      outcome.out,
      AllOf(HasSubstr("(7-Scenes) is now"),
            HasSubstr("images: 15 are hard links to those of the recording, 15 were written"),
            HasSubstr("15 images in 0.47 s, 30.0 Hz, no gaps")));
  EXPECT_THAT(outcome.err, HasSubstr("note: 15 of 15 images have no true pose"));
  const auto run = [this](const fs::path& recording, const std::string& name) {
    const fs::path result = folder_.path() / name;
    const Outcome ran = call({"run", "orb_baseline", "--dataset", recording.string(), "-o",
                              result.string(), "--set", "runtime.mode=inline"});
    EXPECT_EQ(ran.exit_code, 0) << ran.err;
    return poses_of(result / "trajectory.txt");
  };
  EXPECT_EQ(run(out(), "imported"), run(original.path(), "direct"));
}

TEST_F(Import, QuietSaysNothing) {
  SensWriter writer;
  writer.images.push_back(
      {.color = importing::flat_color({64, 48}), .depth = importing::flat_depth(1500, {64, 48})});
  const fs::path file = writer.save(folder_.path() / "scene.sens");
  const Outcome outcome = import(file, {"--quiet"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.out + outcome.err, "");
  EXPECT_TRUE(fs::exists(out() / "groundtruth.txt"));
  const Outcome again = import(file);
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_THAT(again.err, HasSubstr("out: is there already"));
  fs::remove_all(out());
  EXPECT_THAT(import(file, {"--camera", "tum_fr1"}).err,
              HasSubstr("--camera: the recording brings its camera; leave it out"));
}

TEST_F(Import, SaysWhatItLookedFor) {
  Outcome outcome = import(folder_.path());
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("the layout is not recognised; looked for frame-000000.color.png"),
                    HasSubstr("a .sens file (scannet)")));
  outcome = import(folder_.path() / "nowhere");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("nowhere: no such file or folder"));
  outcome = import(std::string(300, 'x'));
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("x: File name too long"));
  outcome = import(folder_.path(), {"--layout", "7scenes"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("no layout '7scenes'; did you mean '7-scenes'?"));
  for (const auto& layout : importing::layouts()) {
    outcome = import(folder_.path(), {"--layout", layout.name});
    EXPECT_EQ(outcome.exit_code, 3) << layout.name;
    EXPECT_THAT(outcome.err, HasSubstr(folder_.path().string())) << layout.name;
  }
  EXPECT_FALSE(fs::exists(out()));
}

TEST_F(Import, NamesARecordingInTheFolder) {
  importing::write_image(folder_.path() / "chess/seq-02/frame-000000.color.png",
                         importing::flat_color());
  const Outcome outcome = import(folder_.path() / "chess");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("chess: holds recordings, but is none; give one of them, such as"),
                    HasSubstr("chess/seq-02")));
}

TEST_F(Import, ATumRecordingNeedsNone) {
  const RecordingCopy recording(2);
  const Outcome outcome = import(recording.path());
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("is in the layout of the TUM benchmark already; give it to "
                                     "'run --dataset' as it is"));
}

}  // namespace
}  // namespace stillpoint::testing
