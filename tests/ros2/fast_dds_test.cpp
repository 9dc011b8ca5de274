// A run that hears images of Fast DDS, and whose topics Fast DDS reads.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <opencv2/imgproc.hpp>

#include "evaluation/trajectory.hpp"
#include "ros2/fast_messages.hpp"
#include "ros2/robot_truth.hpp"
#include "support/dds_loopback.hpp"
#include "support/image_io.hpp"
#include "support/simulated_recording.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::Pair;

std::string type(const std::string& package, const std::string& name) {
  return package + "::msg::dds_::" + name + "_";
}

template <class Read>
auto all_of(const FastReader& reader, Read read) {
  std::vector<decltype(read(Payload{}))> messages;
  for (const Payload& payload : reader.messages()) messages.push_back(read(payload));
  return messages;
}

/// What a robot's nodes are to a run: a driver of a camera, and readers.
class FastDdsTest : public ::testing::Test {
 protected:
  std::vector<std::string> arguments(const std::vector<std::string>& settings,
                                     const std::vector<std::string>& outputs = {"ros2"}) const {
    std::vector<std::string> all = {"run",        "orb_baseline", "-o",
                                    out.string(), "--set",        "source.type=ros2"};
    for (const std::string& setting : settings) all.insert(all.end(), {"--set", setting});
    for (const std::string& output : outputs) all.insert(all.end(), {"--with", output});
    return all;
  }
  static std::vector<std::string> with_camera(std::vector<std::string> all) {
    all.insert(all.end(), {"--camera", (simulated_recording() / "camera.yaml").string()});
    return all;
  }
  Surroundings surroundings() const {
    return {.folder = folder.path(), .environment = {{"ROS_DOMAIN_ID", std::to_string(domain)}}};
  }

  /// Again and again until `condition`: who has just been found may not have found the writer yet.
  void write_until(const std::function<void()>& write, const std::function<bool()>& condition) {
    constexpr int kTries = 100;
    for (int i = 0; i < kTries; ++i) {
      write();
      if (node.news().wait(condition, std::chrono::milliseconds(200))) return;
    }
    ADD_FAILURE() << "no answer";
  }

  const int domain = loopback_domain();
  const TemporaryFolder folder;
  const fs::path out = folder.path() / "out";
  FastNode node{domain};
  const std::string image_type = type("sensor_msgs", "Image");
};

TEST_F(FastDdsTest, HearsADriverAndReadsPosesAndMaps) {
  constexpr std::size_t kFrames = 30;
  const Camera camera{
      .width = 640, .height = 480, .fx = 535.4, .fy = 539.2, .cx = 320.1, .cy = 247.6};
  FastWriter& color = node.publish("/rgb/image_raw", image_type);
  FastWriter& depth = node.publish("/depth_registered/image_raw", image_type);
  FastWriter& info = node.publish("/rgb/camera_info", type("sensor_msgs", "CameraInfo"));
  FastReader& tf = node.subscribe("/tf", type("tf2_msgs", "TFMessage"));
  FastReader& tf_static =
      node.subscribe("/tf_static", type("tf2_msgs", "TFMessage"), Quality::kTransientLocal);
  FastReader& odom = node.subscribe("/stillpoint/odom", type("nav_msgs", "Odometry"));
  FastReader& pose = node.subscribe("/stillpoint/pose", type("geometry_msgs", "PoseStamped"));
  // The first one may be sent before this reader is known.
  FastReader& state = node.subscribe(
      "/stillpoint/state", type("diagnostic_msgs", "DiagnosticStatus"), Quality::kTransientLocal);
  FastReader& path = node.subscribe("/stillpoint/path", type("nav_msgs", "Path"));
  FastReader& landmarks =
      node.subscribe("/stillpoint/landmarks", type("sensor_msgs", "PointCloud2"));
  FastReader& dense = node.subscribe("/stillpoint/dense_map", type("sensor_msgs", "PointCloud2"));
  FastReader& octomap = node.subscribe("/stillpoint/octomap", type("octomap_msgs", "Octomap"),
                                       Quality::kTransientLocal);
  FastReader& grid = node.subscribe("/stillpoint/grid", type("nav_msgs", "OccupancyGrid"),
                                    Quality::kTransientLocal);
  const std::vector<Images> images = recorded_images(kFrames);

  Program program(arguments({"source.reliable=true", "source.queue_size=100",
                             "source.limit=" + std::to_string(kFrames), "map_backend.type=octomap"},
                            {"ros2.base_frame=base_link",
                             "ros2.base_from_camera=[0.1, 0, 1.2, -0.5, 0.5, -0.5, 0.5]"}),
                  surroundings());
  ASSERT_TRUE(node.wait_for_partners());
  const auto write = [&](const Images& each) {
    cv::Mat rgb, metres;
    cv::cvtColor(each.color, rgb, cv::COLOR_BGR2RGB);
    each.depth.convertTo(metres, CV_32F, 1 / 5000.0);
    info.write(camera_info_payload(each.header, camera));
    color.write(image_payload(each.header, rgb, "rgb8"));
    depth.write(image_payload(each.header, metres, "32FC1"));
  };
  write_until([&] { write(images[0]); }, [&] { return !state.messages().empty(); });
  for (std::size_t i = 1; i < kFrames; ++i) write(images[i]);
  const Outcome outcome = program.finish();
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(json_file(out / "summary.json")["tracked_frames"], kFrames);
  const double end = images.back().header.seconds();
  // An acknowledged message may be on its way to the listener yet; maps come meanwhile as well.
  ASSERT_TRUE(node.news().wait([&] {
    return std::ranges::all_of(
               std::array{&tf, &odom, &pose},
               [](const FastReader* reader) { return reader->messages().size() >= kFrames - 1; }) &&
           !landmarks.messages().empty() && !dense.messages().empty() &&
           !octomap.messages().empty() && !grid.messages().empty() && !path.messages().empty() &&
           read_octree(octomap.messages().back()).header.seconds() == end &&
           read_grid(grid.messages().back()).header.seconds() == end &&
           read_path(path.messages().back()).size() == kFrames;
  })) << odom.messages().size()
      << " odometry, " << grid.messages().size() << " grids";

  const Truth truth(images.front().header.seconds(), base_from_camera());
  check_poses(truth, all_of(pose, read_pose), kFrames);
  std::vector<FastPose> of_odometry, of_tf;
  for (const FastOdometry& each : all_of(odom, read_odometry)) {
    of_odometry.push_back(each.pose);
    EXPECT_EQ(each.pose.child, "base_link");
    EXPECT_TRUE(each.covariance.isApprox(each.covariance.transpose()));
  }
  check_poses(truth, of_odometry, kFrames);
  for (const auto& each : all_of(tf, read_transforms)) of_tf.push_back(each.at(0));
  check_poses(truth, of_tf, kFrames);
  EXPECT_EQ(of_tf.back().child, "base_link");
  check_poses(truth, read_path(path.messages().back()), kFrames);
  const FastPose world = read_transforms(tf_static.messages().at(0)).at(0);
  EXPECT_EQ(world.child, "map_optical");
  EXPECT_TRUE(world.header_from_child.isApprox(base_from_camera(), 1e-6));
  const FastState last = read_state(state.messages().back());
  EXPECT_EQ(last.level, 0);
  EXPECT_EQ(last.message, "tracking");
  EXPECT_THAT(last.values, Contains(std::pair<std::string, std::string>("frame", "29")));
  // Not how many: a first image that is written again is dropped.
  EXPECT_THAT(last.values, Contains(Pair("dropped", Not(IsEmpty()))));

  const FastCloud points = read_cloud(landmarks.messages().back());
  EXPECT_THAT(points.fields, ElementsAre("x", "y", "z"));
  EXPECT_GT(points.width, 500U);
  EXPECT_EQ(points.data.size(), points.width * points.point_step);
  const FastCloud voxels = read_cloud(dense.messages().back());
  EXPECT_THAT(voxels.fields, ElementsAre("x", "y", "z", "rgb", "label"));
  EXPECT_GT(voxels.width, 1000U);
  const FastOctree octree = read_octree(octomap.messages().back());
  EXPECT_TRUE(octree.binary);
  EXPECT_EQ(octree.id, "OcTree");
  EXPECT_EQ(octree.resolution, 0.05);
  EXPECT_EQ(octree.header.frame, "map_optical");
  EXPECT_THAT(text_of(out / "map/map.bt"),
              EndsWith(std::string(octree.data.begin(), octree.data.end())));
  check_grid(truth, read_grid(grid.messages().back()));
}

// A driver with the profile of sensors, and depth that comes 4 ms later, in millimetres. What is
// lost on the way is not sent again: the next pair comes when this one has been answered.
TEST_F(FastDdsTest, HearsSensorDataWhoseStampsDiffer) {
  constexpr std::size_t kFrames = 20;
  FastWriter& color = node.publish("/camera/color", image_type, Quality::kSensorData);
  FastWriter& depth = node.publish("/camera/depth", image_type, Quality::kSensorData);
  FastReader& state = node.subscribe("/robot/state", type("diagnostic_msgs", "DiagnosticStatus"),
                                     Quality::kTransientLocal);
  FastReader& tf = node.subscribe("/tf", type("tf2_msgs", "TFMessage"));
  const std::vector<Images> images = recorded_images(kFrames);
  Program program(with_camera(arguments(
                      {"source.color_topic=/camera/color", "source.depth_topic=camera/depth",
                       "source.approximate=true", "source.depth_factor=1000", "source.timeout=2"},
                      {"ros2.name=robot"})),
                  surroundings());
  ASSERT_TRUE(node.wait_for_partners());
  const auto write = [&](const Images& each) {
    cv::Mat millimetres;
    each.depth.convertTo(millimetres, CV_16U, 0.2);
    FastHeader later = each.header;
    later.nanosec += 4'000'000;
    color.write(image_payload(each.header, each.color, "bgr8"));
    depth.write(image_payload(later, millimetres, "16UC1"));
  };
  for (std::size_t i = 0; i < kFrames; ++i)
    write_until([&] { write(images[i]); }, [&] { return state.messages().size() > i; });
  const Outcome outcome = program.finish();
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("no images for 2 s: this is taken for the end"));
  const Truth truth(images.front().header.seconds(), optical());
  std::vector<FastPose> of_tf;
  for (const auto& each : all_of(tf, read_transforms)) of_tf.push_back(each.at(0));
  check_poses(truth, of_tf, kFrames);
  EXPECT_EQ(of_tf.back().child, "camera_color_optical_frame");
}

TEST_F(FastDdsTest, TellsAnEncodingThatIsNotRead) {
  FastWriter& color = node.publish("/rgb/image_raw", image_type);
  // The first one may be sent before this reader is known.
  FastReader& state = node.subscribe(
      "/stillpoint/state", type("diagnostic_msgs", "DiagnosticStatus"), Quality::kTransientLocal);
  Program program(with_camera(arguments({"source.reliable=true"})), surroundings());
  ASSERT_TRUE(node.wait_for_partners());
  const Payload image = image_payload({1, 0, "camera"}, cv::Mat::zeros(480, 640, CV_8UC2), "nv21");
  write_until([&] { color.write(image); }, [&] { return !state.messages().empty(); });
  const Outcome outcome = program.finish();
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("rgb/image_raw: "), HasSubstr("'nv21'")));
  const FastState failure = read_state(state.messages().back());
  EXPECT_EQ(failure.level, 2);
  EXPECT_THAT(failure.message, HasSubstr("'nv21'"));
}

/// Again and again, with stamps that go on.
[[noreturn]] void publish_for_ever(int domain, const std::vector<Images>& images) noexcept {
  FastNode node(domain);
  FastWriter& color = node.publish("/rgb/image_raw", type("sensor_msgs", "Image"));
  FastWriter& depth = node.publish("/depth_registered/image_raw", type("sensor_msgs", "Image"));
  node.wait_for_partners();
  for (std::int32_t second = 0;; ++second)
    for (const Images& each : images) {
      FastHeader header = each.header;
      header.sec += second;
      cv::Mat millimetres;
      each.depth.convertTo(millimetres, CV_16U, 0.2);
      color.write(image_payload(header, each.color, "bgr8"));
      depth.write(image_payload(header, millimetres, "16UC1"));
    }
}

// A driver that crashes, or a player of a bag that is killed.
TEST(FastDdsPublisher, WhenItIsKilledTheRunEndsByItselfWithWhatItHas) {
  constexpr std::size_t kFrames = 5;
  const int domain = loopback_domain();
  const std::vector<Images> images = recorded_images(kFrames);
  const pid_t driver = ::fork();  // before this process has threads of DDS
  if (driver == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    publish_for_ever(domain, images);
  }
  const TemporaryFolder folder;
  const fs::path out = folder.path() / "out";
  FastNode node(domain);
  // The first one may be sent before this reader is known.
  FastReader& state = node.subscribe(
      "/stillpoint/state", type("diagnostic_msgs", "DiagnosticStatus"), Quality::kTransientLocal);
  Program program(
      {"run", "orb_baseline", "-o", out.string(), "--with", "ros2", "--camera",
       (simulated_recording() / "camera.yaml").string(), "--set", "source.type=ros2", "--set",
       "source.reliable=true", "--set", "source.depth_factor=1000", "--set", "source.timeout=2"},
      {.folder = folder.path(), .environment = {{"ROS_DOMAIN_ID", std::to_string(domain)}}});
  EXPECT_TRUE(node.news().wait([&] { return state.messages().size() >= kFrames; }));
  ::kill(driver, SIGKILL);
  ::waitpid(driver, nullptr, 0);
  const Outcome outcome = program.finish();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("no images for 2 s: this is taken for the end"));
  EXPECT_TRUE(json_file(out / "summary.json")["complete"]);
  EXPECT_GE(count_poses(out / "trajectory.txt"), kFrames - 1);
}

}  // namespace
}  // namespace stillpoint::testing
