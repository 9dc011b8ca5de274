// Recordings as cameras give them: a video with depth images beside it, and 60 Hz at the sensor's
// pace.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <opencv2/videoio.hpp>
#include <sstream>
#include <string>

#include "support/absolute_error.hpp"
#include "support/image_io.hpp"
#include "support/simulated_recording.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr int kFrames = 30;

/// A simulated recording as a video of Motion JPEG, a folder of depth images and a list of times.
class AVideo : public ::testing::Test {
 protected:
  AVideo() {
    const RecordingCopy recording(kFrames);
    fs::create_directories(folder.path() / "depth");
    for (const char* name : {"camera.yaml", "groundtruth.txt"})
      fs::copy_file(recording.path() / name, folder.path() / name);
    cv::VideoWriter video((folder.path() / "video.avi").string(), cv::CAP_OPENCV_MJPEG,
                          cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 30, {640, 480});
    video.set(cv::VIDEOWRITER_PROP_QUALITY, 95);
    for (int i = 0; i < kFrames; ++i) {
      video.write(read_image(recording.color(i)));
      fs::copy_file(recording.depth(i), folder.path() / "depth" / recording.depth(i).filename());
    }
    folder.write("times.txt", recording.read("rgb.txt"));
  }
  Outcome run(const Surroundings& surroundings = {}) const {
    return call({"run", "orb_baseline", "--dataset", folder.path().string(), "-o", out.string(),
                 "--set", "source.type=video_file", "--set", "source.times=times.txt"},
                surroundings);
  }

  const TemporaryFolder folder;
  const fs::path out = folder.path() / "out";
};

TEST_F(AVideo, IsTracked) {
  const Outcome outcome = run();
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(json_file(out / "summary.json")["tracked_frames"], kFrames);
  EXPECT_LT(absolute_error(folder.path(), out / "trajectory.txt"), 0.01);  // metres
  EXPECT_THAT(outcome.out, HasSubstr("stillpoint evaluate --reference"));
}

TEST_F(AVideo, ThatIsNoneIsRefused) {
  folder.write("video.avi", "Not Found");
  const Outcome outcome = run();
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("video.avi: OpenCV cannot read this as a video"));
  EXPECT_FALSE(fs::exists(out / "trajectory.txt"));
}

// A damaged one in place of a missing one: the loader goes no further than the first of this name.
TEST_F(AVideo, AloneNeedsTheReaderOfVideos) {
  const TemporaryFolder libraries;
  libraries.write(STILLPOINT_VIDEOIO, "no library");
  const Surroundings without{.environment = {{"LD_LIBRARY_PATH", libraries.path().string()}}};
  EXPECT_EQ(call({"plugins", "list", "--strict"}, without).exit_code, 0);
  const Outcome outcome = run(without);
  EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("on Debian the package libopencv-videoio406"));
}

TEST(V4l2Camera, MayBeMissing) {
  const Outcome outcome = call({"run", "orb_baseline", "--camera", "tum_fr1", "--set",
                                "source.type=v4l2", "--set", "source.color_device=/dev/video99"});
  EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("/dev/video99: cannot be opened: No such file"));
}

// A busy machine may drop frames, which are told; what it does track is right.
TEST(SixtyHertz, AreTrackedAtThePaceOfTheSensor) {
  constexpr int kImages = 60;
  const fs::path recording = recording_of(kScene, kImages, with_small_images({"source.rate=60"}));
  const TemporaryFolder folder;
  const fs::path out = folder.path() / "out";
  const Outcome outcome = call({"run", "orb_baseline", "--dataset", recording.string(), "-o",
                                out.string(), "--set", "runtime.pace=sensor"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto summary = json_file(out / "summary.json");
  EXPECT_EQ(summary["frames"], kImages);
  EXPECT_EQ(summary["processed_frames"].get<int>() + summary["dropped_frames"].get<int>(), kImages);
  EXPECT_EQ(summary["times_lost"], 0);
  EXPECT_LT(absolute_error(recording, out / "trajectory.txt"), 0.01);  // metres
}

}  // namespace
}  // namespace stillpoint::testing
