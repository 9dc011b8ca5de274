#include "my_plugin.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stillpoint/testing/test_recording.hpp>
#include <string>
#include <vector>

namespace plugins::my_plugin {
namespace {

namespace fs = std::filesystem;
using stillpoint::testing::TestRecording;

class MyPluginTest : public ::testing::Test {
 protected:
  MyPluginTest() : folder_(fs::path(::testing::TempDir()) / "my_plugin_test") {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~MyPluginTest() override { fs::remove_all(folder_); }

  stillpoint::StageContext context() const {
    stillpoint::StageContext context = stillpoint::testing::test_context();
    context.output_directory = folder_;
    return context;
  }
  std::string written(const std::string& name = "my_plugin.csv") const {
    std::ifstream stream(folder_ / name);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  static void finish(MyPlugin& output) {
    output.finish({.map = {}, .poses = {}, .source = {}, .times = {}});
  }

  const fs::path folder_;
};

TEST_F(MyPluginTest, WritesALineForEachFrame) {
  const TestRecording recording({.frames = 2});
  MyPlugin output(MyPlugin::Options{}, context());
  output.frame({.frame = recording.frame(0)});  // nothing else is known
  stillpoint::FrameReport report{.frame = recording.frame(1),
                                 .moving = recording.moving_points(1),
                                 .weights = recording.weights(1)};
  report.result.state = stillpoint::TrackState::kTracking;
  report.result.world_from_camera.translation() = Eigen::Vector3d(1, 2, 3);
  report.result.inliers = 42;
  output.frame(report);
  EXPECT_EQ(written(), "");  // not before it is complete
  finish(output);
  const std::string text = written();
  EXPECT_NE(text.find("\n0,0.000000,waiting,,,,0,0,1.000000\n"), std::string::npos) << text;
  EXPECT_NE(text.find("\n1,0.033333,tracking,1.000000,2.000000,3.000000,42,"), std::string::npos)
      << text;
}

TEST_F(MyPluginTest, WithoutFramesThereIsTheHeading) {
  MyPlugin output({.file = "other.csv"}, context());
  finish(output);
  EXPECT_EQ(written("other.csv").rfind("frame,time,", 0), 0u);
}

}  // namespace
}  // namespace plugins::my_plugin
