#include "simulation/recording_writer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "stillpoint/error.hpp"
#include "support/image_io.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint::simulation {
namespace {

class RecordingWriterTest : public ::testing::Test {
 protected:
  RecordingWriterTest()
      : folder_(std::filesystem::path(::testing::TempDir()) /
                ::testing::UnitTest::GetInstance()->current_test_info()->name()) {
    std::filesystem::remove_all(folder_);
  }
  ~RecordingWriterTest() override { std::filesystem::remove_all(folder_); }

  std::string text(const char* name) const {
    std::ostringstream content;
    content << std::ifstream(folder_ / name).rdbuf();
    return content.str();
  }

  std::filesystem::path folder_;
};

TEST_F(RecordingWriterTest, WritesAFolderOfTheBenchmark) {
  SceneOptions scene;
  scene.frames = 2;
  scene.room.furnished = false;
  scene.sensor.depth_offset = 0.005;
  Simulator simulator(scene, {.width = 64, .height = 48, .fx = 50, .fy = 50, .cx = 32, .cy = 24},
                      1);
  RecordingWriter writer(folder_);
  const SimulatedFrame frame = simulator.frame(0);
  writer.write(frame);
  writer.write(simulator.frame(1));
  writer.write_ground_truth(simulator, 2);

  EXPECT_THAT(text("rgb.txt"), ::testing::EndsWith("1000.033333 rgb/1000.033333.png\n"));
  EXPECT_EQ(text("associations.txt"),
            "1000.000000 rgb/1000.000000.png 1000.005000 depth/1000.005000.png\n"
            "1000.033333 rgb/1000.033333.png 1000.038333 depth/1000.038333.png\n");
  const cv::Mat depth =
      testing::read_image((folder_ / "depth" / "1000.005000.png"), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(depth.type(), CV_16UC1);
  EXPECT_EQ(cv::norm(depth, frame.depth, cv::NORM_INF), 0);
  const cv::Mat color = testing::read_image((folder_ / "rgb" / "1000.000000.png"));
  EXPECT_EQ(cv::norm(color.reshape(1), frame.bgr.reshape(1), cv::NORM_INF), 0);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "labels" / "1000.033333.png"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "instances" / "1000.033333.png"));
}

TEST_F(RecordingWriterTest, ListsFramesInTheirOrderWhenAllBeforeAreThere) {
  SimulatedFrame frame{.bgr = cv::Mat::zeros(2, 2, CV_8UC3),
                       .depth = cv::Mat::zeros(2, 2, CV_16UC1),
                       .labels = cv::Mat::zeros(2, 2, CV_8UC1),
                       .instances = cv::Mat::zeros(2, 2, CV_8UC1)};
  RecordingWriter writer(folder_);
  const auto write = [&](int index) {
    frame.index = index;
    frame.time = frame.depth_time = index;
    writer.write(frame);
  };
  const std::string header = text("rgb.txt");
  write(2);
  write(1);
  EXPECT_EQ(text("rgb.txt"), header);
  write(0);
  EXPECT_EQ(text("rgb.txt"), header +
                                 "0.000000 rgb/0.000000.png\n"
                                 "1.000000 rgb/1.000000.png\n"
                                 "2.000000 rgb/2.000000.png\n");
}

TEST_F(RecordingWriterTest, GroundTruthIsTheMotionAt100Hz) {
  SceneOptions scene;
  scene.room.furnished = false;
  const Simulator simulator(scene, default_camera(), 1);
  RecordingWriter(folder_).write_ground_truth(simulator, 31);
  std::ifstream file(folder_ / "groundtruth.txt");
  std::string line;
  double last = 0;
  int lines = 0;
  while (std::getline(file, line)) {
    if (line[0] == '#') continue;
    std::istringstream fields(line);
    double time = 0;
    Eigen::Vector3d t;
    Eigen::Quaterniond q;
    fields >> time >> t.x() >> t.y() >> t.z() >> q.x() >> q.y() >> q.z() >> q.w();
    ASSERT_TRUE(fields) << line;
    const Pose truth = simulator.world_from_camera(time);
    EXPECT_LT((truth.translation() - t).norm(), 2e-6);
    EXPECT_LT(q.angularDistance(Eigen::Quaterniond(truth.linear())), 1e-6);
    if (lines++ > 0) {
      EXPECT_NEAR(time - last, 0.01, 1e-6);
    }
    last = time;
  }
  EXPECT_EQ(lines, 111);  // 1 s and 50 ms before and after
}

TEST_F(RecordingWriterTest, DoesNotWriteOverAPartOfARecording) {
  for (const char* name : {"groundtruth.txt", "depth.txt", "associations.txt", "camera.yaml"}) {
    const testing::TemporaryFolder folder;
    folder.write(name, "the user's");
    EXPECT_THROW(RecordingWriter{folder.path()}, Error) << name;
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "rgb.txt"));
  }
}

TEST_F(RecordingWriterTest, DoesNotWriteOverARecording) {
  { const RecordingWriter first(folder_); }
  try {
    const RecordingWriter second(folder_);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kUsage);
    EXPECT_THAT(error.what(), ::testing::HasSubstr("recording already"));
  }
}

}  // namespace
}  // namespace stillpoint::simulation
