// stillpoint record: what it writes is the recording that the source gives.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <regex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "support/image_io.hpp"
#include "support/simulated_recording.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr int kRecordedFrames = 12;

class Record : public ::testing::Test {
 protected:
  fs::path out() const { return folder_.path() / "out"; }

  static Outcome record_to(const fs::path& target, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "record");
    arguments.insert(arguments.end(), {"-o", target.string()});
    return call(std::move(arguments));
  }
  Outcome record(std::vector<std::string> arguments) const {
    return record_to(out(), std::move(arguments));
  }
  static std::vector<std::string> pipeline_for(const RecordingCopy& recording) {
    return {"orb_baseline", "--dataset", recording.path().string(), "--camera",
            (recording.path() / "camera.yaml").string()};
  }
  /// A pipeline whose source renders a small scene.
  std::string simulated_pipeline(int frames) const {
    return folder_
        .write("simulated.yaml",
               "version: 1\nextends: orb_baseline\n"
               "source: {type: simulation, people: [], balls: [], frames: " +
                   std::to_string(frames) +
                   "}\ncamera: {width: 320, height: 240, fx: 267.7, fy: 269.6, "
                   "cx: 159.8, cy: 123.6, depth_factor: 5000}\n")
        .string();
  }
  /// The trajectory that `stillpoint run` finds, inline.
  std::string trajectory(std::vector<std::string> arguments) const {
    const fs::path results = folder_.path() / "run";
    arguments.insert(arguments.begin(), "run");
    arguments.insert(arguments.end(), {"-o", results.string(), "--set", "runtime.mode=inline"});
    const Outcome outcome = call(std::move(arguments));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return text_of(results / "trajectory.txt");
  }
  std::string trajectory_of_recording() const {
    return trajectory({"orb_baseline", "--dataset", out().string(), "--camera",
                       (out() / "camera.yaml").string()});
  }
  /// Files in a list of images.
  std::vector<fs::path> images(const fs::path& recording, const std::string& list) const {
    std::istringstream stream(text_of(recording / list));
    std::vector<fs::path> files;
    for (std::string line; std::getline(stream, line);)
      if (!line.starts_with("#")) files.push_back(recording / line.substr(line.find(' ') + 1));
    return files;
  }
  /// Every image that is listed can be read.
  std::size_t count_whole_frames() const {
    std::size_t count = 0;
    for (const char* list : {"rgb.txt", "depth.txt"}) {
      count = 0;
      for (const fs::path& file : images(out(), list)) {
        EXPECT_FALSE(read_image(file, cv::IMREAD_UNCHANGED).empty()) << file;
        ++count;
      }
    }
    return count;
  }

  TemporaryFolder folder_;
};

TEST_F(Record, ARecordingOfARecordingIsTheSame) {
  const RecordingCopy original(kRecordedFrames);
  const Outcome outcome = record(pipeline_for(original));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("12 frames of 0.4 s, 0 dropped"),
                                 HasSubstr("--camera " + out().string() + "/camera.yaml")));
  for (const char* file : {"rgb.txt", "depth.txt", "groundtruth.txt"})
    EXPECT_EQ(text_of(out() / file), original.read(file)) << file;
  for (const char* list : {"rgb.txt", "depth.txt"})
    for (const fs::path& file : images(original.path(), list)) {
      const fs::path copy = out() / fs::relative(file, original.path());
      EXPECT_EQ(cv::norm(read_image(file, cv::IMREAD_UNCHANGED),
                         read_image(copy, cv::IMREAD_UNCHANGED), cv::NORM_INF),
                0)
          << file;
    }
  EXPECT_FALSE(fs::exists(out() / "labels"));
  EXPECT_EQ(trajectory_of_recording(), trajectory(pipeline_for(original)));
}

/// What follows this word at the beginning of a line.
std::string line_of(const std::string& text, const std::string& word) {
  const std::size_t begin = text.find(word + "   ");
  if (begin == std::string::npos) return "no line '" + word + "' in " + text;
  const std::size_t command = text.find("stillpoint ", begin);
  return text.substr(command, text.find('\n', command) - command);
}

// In a folder whose name a shell would take for something else.
TEST_F(Record, TheCommandsThatItAndTheRunPrintCanBeTyped) {
  const fs::path folder = folder_.path() / "it's $HOME";
  const Outcome recorded = record_to(
      folder,
      {"orb_baseline", "--dataset", simulated_recording().string(), "--set", "source.limit=5"});
  const auto typed = [&](std::string line, const std::string& more) {
    EXPECT_THAT(line, ::testing::StartsWith("stillpoint "));
    line.replace(0, 10, "'" + program_file().string() + "'");
    if (const auto name = line.find("PIPELINE"); name != std::string::npos)
      line.replace(name, 8, "orb_baseline");
    const fs::path out_file = folder_.path() / "out.txt";
    EXPECT_EQ(std::system((line + more + " > '" + out_file.string() + "' 2>&1").c_str()), 0)
        << line;
    return text_of(out_file);
  };
  const std::string run =
      typed(line_of(recorded.out, "run"), " -o '" + (folder_.path() / "a b").string() + "'");
  EXPECT_THAT(typed(line_of(run, "compare"), ""), HasSubstr("ATE"));
}

// As a folder, and as an MCAP file, which the source `bag` reads.
TEST_F(Record, ARecordingOfTheSimulatorGivesItsTrajectory) {
  const std::string pipeline = simulated_pipeline(kRecordedFrames);
  const Outcome outcome = record({pipeline});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(count_whole_frames(), static_cast<std::size_t>(kRecordedFrames));
  EXPECT_FALSE(fs::exists(out() / "groundtruth.txt"));  // rendered in memory: there is no file
  const std::string direct = trajectory({pipeline});
  EXPECT_EQ(std::count(direct.begin(), direct.end(), '\n'), kRecordedFrames + 1);
  EXPECT_EQ(trajectory_of_recording(), direct);

  const fs::path mcap = folder_.path() / "out.mcap";
  const Outcome as_mcap = record_to(mcap, {pipeline});
  ASSERT_EQ(as_mcap.exit_code, 0) << as_mcap.err;
  EXPECT_THAT(as_mcap.out, HasSubstr("run PIPELINE --dataset " + mcap.string() + "\n"));
  EXPECT_EQ(trajectory({"orb_baseline", "--dataset", mcap.string()}), direct);
}

TEST_F(Record, AtTheSensorsPaceEveryFrameIsWrittenOrCounted) {
  const RecordingCopy original(kRecordedFrames);
  std::vector<std::string> arguments = pipeline_for(original);
  arguments.insert(arguments.end(), {"--set", "runtime.pace=sensor"});
  const Outcome outcome = record(std::move(arguments));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  std::smatch found;
  ASSERT_TRUE(
      std::regex_search(outcome.out, found, std::regex(R"((\d+) frames of .*, (\d+) dropped)")))
      << outcome.out;
  EXPECT_EQ(std::stoi(found[1]) + std::stoi(found[2]), kRecordedFrames);
  EXPECT_EQ(count_whole_frames(), std::stoul(found[1]));
}

TEST_F(Record, WritesOverNothing) {
  folder_.write("out/mine.txt", "precious");
  const RecordingCopy original(1);
  const Outcome folder = record(pipeline_for(original));
  EXPECT_EQ(folder.exit_code, 2);
  EXPECT_EQ(folder.err,
            "error: " + out().string() +
                ": there is something already; name another target or remove this one\n");
  EXPECT_EQ(text_of(out() / "mine.txt"), "precious");
  EXPECT_FALSE(fs::exists(out() / "rgb"));
  const fs::path mcap = folder_.write("old.mcap", "precious");
  const Outcome file = record_to(mcap, pipeline_for(original));
  EXPECT_EQ(file.exit_code, 2);
  EXPECT_THAT(file.err, HasSubstr("there is something already"));
  EXPECT_EQ(text_of(mcap), "precious");
}

TEST_F(Record, OneThatFailsBeforeItsFirstFrameLeavesNothing) {
  const RecordingCopy original(1);
  folder_.write("other.yaml",
                "camera: {width: 320, height: 240, fx: 260, fy: 260, cx: 160, cy: 120, "
                "depth_factor: 5000}\n");
  for (const char* target : {"out", "out.mcap"}) {
    const Outcome outcome =
        record_to(folder_.path() / target, {"orb_baseline", "--dataset", original.path().string(),
                                            "--camera", (folder_.path() / "other.yaml").string()});
    EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
    EXPECT_THAT(outcome.out, ::testing::Not(HasSubstr("files")));
    EXPECT_FALSE(fs::exists(folder_.path() / target));
  }
}

TEST_F(Record, CtrlCLeavesAWholeRecording) {
  Program program({"record", simulated_pipeline(400), "-o", out().string()});
  ASSERT_TRUE(program.wait_for("frames/s"));
  program.send(SIGINT);
  const Outcome outcome = program.finish();
  EXPECT_EQ(outcome.signal, SIGINT);
  EXPECT_THAT(outcome.err, HasSubstr("what was recorded until then is complete"));
  std::smatch found;
  ASSERT_TRUE(std::regex_search(outcome.out, found, std::regex(R"((\d+) frames)"))) << outcome.out;
  EXPECT_EQ(count_whole_frames(), std::stoul(found[1]));
  EXPECT_TRUE(fs::exists(out() / "camera.yaml"));
}

TEST_F(Record, AKilledOneLeavesWhatItsListsName) {
  Program program({"record", simulated_pipeline(400), "-o", out().string()});
  ASSERT_TRUE(program.wait_for("frames/s"));
  program.send(SIGKILL);
  EXPECT_EQ(program.finish().signal, SIGKILL);
  EXPECT_GT(count_whole_frames(), 0u);
}

TEST_F(Record, AKilledMcapFileIsReadAsFarAsItGoes) {
  const fs::path file = folder_.path() / "out.mcap";
  Program program({"record", simulated_pipeline(400), "-o", file.string()});
  ASSERT_TRUE(program.wait_for("frames/s"));
  program.send(SIGKILL);
  EXPECT_EQ(program.finish().signal, SIGKILL);
  const Outcome outcome = call({"run", "orb_baseline", "--dataset", file.string(), "-o",
                                (folder_.path() / "run").string(), "--set", "source.limit=5"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(count_poses(folder_.path() / "run/trajectory.txt"), 5u);
}

TEST_F(Record, AFolderThatCannotBeMadeIsNamed) {
  folder_.write("file", "");
  const RecordingCopy original(1);
  for (const char* target : {"file/recording", "file/recording.mcap"}) {
    const Outcome outcome = record_to(folder_.path() / target, pipeline_for(original));
    EXPECT_EQ(outcome.exit_code, 2);
    EXPECT_THAT(outcome.err,
                AllOf(HasSubstr("cannot make the folder"), HasSubstr("Not a directory")));
  }
}

TEST_F(Record, QuietlyItSaysNothing) {
  const RecordingCopy original(1);
  std::vector<std::string> arguments = pipeline_for(original);
  arguments.emplace_back("--quiet");
  const Outcome outcome = record(std::move(arguments));
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.out + outcome.err, IsEmpty());
}

}  // namespace
}  // namespace stillpoint::testing
