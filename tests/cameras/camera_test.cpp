// Live cameras without hardware: libfreenect's own stand-in for a Kinect, `fakenect`, plays images
// from a folder; OpenNI's DummyDevice makes them up. A preloaded library unplugs them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>
#include <vector>

#include "evaluation/trajectory.hpp"
#include "support/absolute_error.hpp"
#include "support/image_io.hpp"
#include "support/simulated_recording.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr int kFrames = 30;
constexpr int kUsed = 25;                 // a busy machine may drop a few
constexpr double kPeriod = 0.1;           // s, slower than a Kinect, for busy machines
constexpr double kTicksPerSecond = 60e6;  // of a Kinect's counter

// As fakenect-record leaves it: raw pixels behind a header of one line, named by time of arrival
// and the device's counter, which starts over in the middle.
class Dump {
 public:
  explicit Dump(const RecordingCopy& recording) {
    for (int frame = 0; frame < kFrames; ++frame) {
      cv::Mat color = read_image(recording.color(frame), cv::IMREAD_COLOR);
      cv::cvtColor(color, color, cv::COLOR_BGR2RGB);
      cv::Mat depth = read_image(recording.depth(frame), cv::IMREAD_UNCHANGED);
      depth.convertTo(depth, CV_16U, 0.2);  // 5000 per metre to millimetres
      const double seconds = frame * kPeriod;
      add('r', seconds, "P6 640 480 255\n", color, ".ppm");
      add('d', seconds + 0.008, "P5 640 480 65535\n", depth, ".pgm");
    }
    folder_.write("INDEX.txt", index_);
  }
  std::string path() const { return folder_.path().string(); }

 private:
  void add(char kind, double seconds, const std::string& header, const cv::Mat& image,
           const char* ending) {
    const auto ticks = static_cast<std::uint32_t>(
        static_cast<std::uint64_t>(0xffffffffu - 90'000'000u + seconds * kTicksPerSecond));
    const std::string name = std::string(1, kind) + "-" + stamp_text(1000 + seconds) + "-" +
                             std::to_string(ticks) + ending;
    std::string text = header;
    text.append(reinterpret_cast<const char*>(image.data), image.total() * image.elemSize());
    folder_.write(name, text);
    index_ += name + "\n";
  }

  TemporaryFolder folder_;
  std::string index_;
};

using Variables = std::map<std::string, std::string>;

Surroundings with_fakenect(const std::string& dump, Variables more = {}) {
  more.merge(Variables{{"LD_LIBRARY_PATH", STILLPOINT_FAKENECT},
                       {"LD_PRELOAD", STILLPOINT_REGISTERED_DEPTH ":" STILLPOINT_UNPLUGGED},
                       {"FAKENECT_PATH", dump}});
  return {.environment = std::move(more)};
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

void expect_gone_and_back(const Outcome& outcome, const fs::path& run) {
  EXPECT_EQ(count(outcome.err, "; trying to open it again for 30 s"), 1u) << outcome.err;
  EXPECT_EQ(count(outcome.err, "the camera is back, after "), 1u) << outcome.err;
  EXPECT_THAT(json_file(run / "summary.json")["warnings"].dump(),
              HasSubstr("the camera was gone 1 time, for "));
}

// Gives the poses the times of the recording: the camera's begin when it is started.
void write_with_times_of(const fs::path& recording, const fs::path& estimate, const fs::path& out) {
  const auto truth = evaluation::read_trajectory(recording / "groundtruth.txt");
  const auto poses = evaluation::read_trajectory(estimate);
  std::ofstream file(out);
  std::ifstream lines(estimate);
  std::size_t i = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("#")) continue;
    const double frame = std::round((poses.poses[i++].time - poses.start()) / kPeriod);
    file << stamp_text(truth.start() + frame / 30.0) << line.substr(line.find(' ')) << "\n";
  }
}

/// A run of the recording as a Kinect would give it.
class LiveKinect : public ::testing::Test {
 protected:
  std::vector<std::string> arguments(const std::vector<std::string>& settings) const {
    std::vector<std::string> all = {"run",      "orb_baseline",
                                    "-o",       out.string(),
                                    "--camera", (recording.path() / "camera.yaml").string()};
    all.insert(all.end(), {"--set", "source.type=freenect"});
    for (const std::string& setting : settings) all.insert(all.end(), {"--set", setting});
    return all;
  }
  Outcome run(const std::vector<std::string>& settings, const Variables& more = {}) const {
    const Dump dump(recording);
    return call(arguments(settings), with_fakenect(dump.path(), more));
  }
  static std::string limit_of(int frames) { return "source.limit=" + std::to_string(frames); }

  const RecordingCopy recording{kFrames};
  const TemporaryFolder folder;
  const fs::path out = folder.path() / "out";
};

TEST_F(LiveKinect, IsTracked) {
  const Outcome outcome = run({limit_of(kUsed)});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto summary = json_file(out / "summary.json");
  EXPECT_EQ(summary["tracked_frames"], kUsed) << summary;
  EXPECT_EQ(summary["times_lost"], 0);
  const fs::path estimate = folder.path() / "estimate.txt";
  write_with_times_of(recording.path(), out / "trajectory.txt", estimate);
  EXPECT_LT(absolute_error(recording.path(), estimate), 0.005);  // metres
}

TEST_F(LiveKinect, IsRecorded) {
  const Dump dump(recording);
  const fs::path folder_of_images = folder.path() / "recorded";
  const Outcome outcome =
      call({"record", "orb_baseline", "--set", "source.type=freenect", "--set",
            "source.limit=" + std::to_string(kUsed), "--camera",
            (recording.path() / "camera.yaml").string(), "-o", folder_of_images.string()},
           with_fakenect(dump.path()));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr(std::to_string(kUsed) + " frames of"));
  EXPECT_EQ(call({"inspect", folder_of_images.string()}).exit_code, 0);
}

// But for what cannot be the same again, in two runs and in two stages at once.
TEST_F(LiveKinect, KeepsItsContract) {
  const Dump dump(recording);
  const fs::path library =
      build_folder() / "lib/stillpoint/plugins/libstillpoint_source_freenect.so";
  const Outcome outcome = call({"plugins", "check", library.string(), "--set", "limit=5",
                                "--camera", (recording.path() / "camera.yaml").string()},
                               with_fakenect(dump.path()));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  for (const char* passed : {"usual recording", "options", "destroyed at any time"})
    EXPECT_THAT(outcome.out, HasSubstr(std::string("ok    ") + passed));
}

// fakenect ends with its images, as if the cable was pulled.
TEST_F(LiveKinect, KeepsWhatWasTrackedWhenItIsUnplugged) {
  const Outcome outcome = run({"source.reconnect_for=0"});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("Kinect: the camera was unplugged"));
  EXPECT_GE(count_poses(out / "trajectory.txt"), std::size_t{kUsed});
  EXPECT_FALSE(json_file(out / "summary.json")["complete"]);
}

// After the colour image of a pair, which is lost.
TEST_F(LiveKinect, GoesOnWhenItIsPluggedInAgain) {
  const Outcome outcome = run({limit_of(kUsed)}, {{"STILLPOINT_UNPLUG_AFTER", "21"}});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("Kinect: the camera was unplugged; trying"));
  expect_gone_and_back(outcome, out);
  EXPECT_EQ(json_file(out / "summary.json")["frames"], kUsed);
  const auto poses = evaluation::read_trajectory(out / "trajectory.txt").poses;
  EXPECT_GT(poses.size(), 10u);
  for (std::size_t i = 1; i < poses.size(); ++i) EXPECT_GT(poses[i].time, poses[i - 1].time);
}

// It would hang for an hour.
TEST_F(LiveKinect, CtrlCEndsARunWithACameraThatHangs) {
  const Dump dump(recording);
  Program program(arguments({"source.timeout=3600"}),
                  with_fakenect(dump.path(), {{"STILLPOINT_STALL_AFTER", "20"}}));
  ASSERT_TRUE(program.wait_for("the camera hangs"));
  program.send(SIGINT);
  EXPECT_EQ(program.finish().signal, SIGINT);
}

TEST(LiveOpenNi, GoesOnWhenItIsPluggedInAgain) {
  const std::string dummy = STILLPOINT_DUMMY_DEVICE;
  if (!fs::exists(dummy)) GTEST_SKIP() << "OpenNI 2 has no driver DummyDevice here";
  const TemporaryFolder folder;
  const fs::path camera = folder.write("small.yaml",
                                       "camera: {name: small, width: 320, height: 240, fx: 260, "
                                       "fy: 260, cx: 159.5, cy: 119.5, depth_factor: 5000}\n");
  std::vector<std::string> arguments = {
      "run", "orb_baseline", "--camera", camera.string(), "-o", (folder.path() / "out").string()};
  for (const char* setting : {"source.type=openni2", "source.device=Dummy", "source.width=320",
                              "source.height=240", "source.limit=12"})
    arguments.insert(arguments.end(), {"--set", setting});
  const Outcome outcome = call(arguments, {.environment = {{"LD_PRELOAD", STILLPOINT_UNPLUGGED},
                                                           {"STILLPOINT_UNPLUG_AFTER", "9"}}});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("Dummy: the camera sends no more images; trying"));
  expect_gone_and_back(outcome, folder.path() / "out");
  EXPECT_EQ(json_file(folder.path() / "out/summary.json")["frames"], 12);
}

TEST(LiveCamera, MayBeMissing) {
  for (const char* type : {"freenect", "openni2"}) {
    const Outcome outcome =
        call({"run", "orb_baseline", "--set", std::string("source.type=") + type});
    EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("no camera is connected"));
  }
}

// Damaged ones in place of missing ones: the loader goes no further than the first of this name.
TEST(LiveCamera, OnlyItsSourceNeedsTheDriver) {
  const TemporaryFolder folder;
  for (const char* library : {"libfreenect.so.0.5", "libOpenNI2.so.0"})
    folder.write(library, "no library");
  const Surroundings without_drivers{.environment = {{"LD_LIBRARY_PATH", folder.path().string()}}};
  EXPECT_EQ(call({"plugins", "list", "--strict"}, without_drivers).exit_code, 0);
  for (const auto& [type, package] :
       {std::pair("freenect", "libfreenect0.5"), std::pair("openni2", "libopenni2-0")}) {
    const Outcome outcome =
        call({"run", "orb_baseline", "--set", std::string("source.type=") + type}, without_drivers);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(std::string("on Debian the package ") + package));
  }
}

}  // namespace
}  // namespace stillpoint::testing
