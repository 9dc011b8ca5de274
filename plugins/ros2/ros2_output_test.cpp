#include "ros2/ros2_output.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <fstream>

#include "bag/bag_reader.hpp"
#include "bag/messages.hpp"
#include "support/bag_messages.hpp"
#include "support/dds_loopback.hpp"
#include "support/error_text.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint::ros2 {
namespace {

using bag::ByteReader;
using ::testing::AllOf;
using testing::error_text;
using ::testing::HasSubstr;
using testing::loopback_domain;

constexpr auto kCdr = bag::Serialisation::kCdr;

FrameReport report_at(double time, TrackState state, const Pose& world_from_camera) {
  FrameReport report;
  report.frame = std::make_shared<const Frame>(Frame{.time = time});
  report.result.state = state;
  report.result.world_from_camera = world_from_camera;
  report.map = std::make_shared<const SparseMap>();
  return report;
}

/// What is on the topics of an output, read with the decoder of bags.
class Ros2OutputTest : public ::testing::Test {
 protected:
  Ros2OutputTest() { options_.domain = loopback_domain(); }

  Reader reader(const std::string& topic, std::string_view type) const {
    return {participant_, topic, type, 10, true};
  }
  static std::optional<Bytes> taken(const Reader& from) {
    return from.take(std::chrono::steady_clock::now() + std::chrono::milliseconds(1));
  }
  RunSummary summary() const {
    return {.map = map_, .poses = poses_, .source = source_, .times = times_};
  }

  const Participant participant_{loopback_domain()};
  Ros2Output::Options options_;
  SparseMap map_;
  std::vector<TrackedPose> poses_;
  SourceReport source_;
  std::vector<StageTime> times_;
};

TEST_F(Ros2OutputTest, PublishesPosesOfTheBase) {
  options_.base_frame = "base_link";
  options_.base_from_camera = {0, 0, 1, -0.5, 0.5, -0.5, 0.5};  // looks forward
  const Reader tf = reader("/tf", "tf2_msgs/TFMessage");
  Ros2Output output(options_, {});
  output.frame(report_at(2.5, TrackState::kTracking, Pose(Eigen::Translation3d(0, 0, 2))));
  const auto message = taken(tf);
  ASSERT_TRUE(message);
  const auto transforms = bag::read_transforms(*message, kCdr);
  ASSERT_EQ(transforms.size(), 1U);
  EXPECT_EQ(transforms[0].parent, "map");
  EXPECT_EQ(transforms[0].child, "base_link");
  const Eigen::Vector3d position = transforms[0].parent_from_child.translation();
  EXPECT_LT((position - Eigen::Vector3d(2, 0, 0)).norm(), 1e-9);
}

/// What the rest of a robot says on tf.
class Robot {
 public:
  explicit Robot(const Participant& participant)
      : moving_(participant, "/tf", "tf2_msgs/TFMessage", Kept::kShortly),
        fixed_(participant, "/tf_static", "tf2_msgs/TFMessage", Kept::kLast) {}

  void mount(const std::string& base, const std::string& camera, const Pose& pose) const {
    fixed_.write(message(0, base, camera, pose));
  }
  void move(double time, const Pose& odom_from_base) const {
    moving_.write(message(time, "odom", "base_link", odom_from_base));
  }

 private:
  static Bytes message(double time, const std::string& parent, const std::string& child,
                       const Pose& pose) {
    return testing::transforms_message(kCdr, {{.parent = parent,
                                               .child = child,
                                               .parent_from_child = pose,
                                               .stamp = static_cast<std::int64_t>(time * 1e9)}});
  }

  Writer moving_, fixed_;
};

/// On /tf, but not of the robot.
std::optional<bag::TransformMessage> own_transform(const Reader& tf) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(1);
  while (const auto message = tf.take(until))
    for (bag::TransformMessage& transform : bag::read_transforms(*message, kCdr))
      if (transform.child != "base_link" || transform.parent != "odom") return transform;
  return std::nullopt;
}

TEST_F(Ros2OutputTest, PublishesOdometryInTheMap) {
  options_.base_frame = "base_link";
  options_.odom_frame = "odom";
  options_.base_from_camera = {0, 0, 1, -0.5, 0.5, -0.5, 0.5};  // looks forward
  const Reader tf = reader("/tf", "tf2_msgs/TFMessage");
  std::vector<std::string> warnings;
  StageContext context;
  context.log = [&](LogLevel, std::string_view text) { warnings.emplace_back(text); };
  Ros2Output output(options_, context);
  const Robot robot(participant_);
  const auto moved = [](double x) { return Pose(Eigen::Translation3d(x, 0, 0)); };
  output.frame(report_at(1, TrackState::kTracking, Pose::Identity()));
  EXPECT_FALSE(own_transform(tf)) << "nobody knows where the base is in odom";
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0], HasSubstr("tf does not know base_link in odom"));
  robot.move(1.9, moved(2.9));
  robot.move(2.1, moved(3.1));
  output.frame(report_at(2, TrackState::kTracking, Pose(Eigen::Translation3d(0, 0, 2))));
  const auto transform = own_transform(tf);
  ASSERT_TRUE(transform);
  EXPECT_EQ(transform->parent, "map");
  EXPECT_EQ(transform->child, "odom");
  EXPECT_EQ(transform->stamp, 2'000'000'000);
  // The base has gone 2 m along x of the map, and is at 3 m in odom.
  EXPECT_TRUE(transform->parent_from_child.isApprox(moved(2) * moved(3).inverse(), 1e-6));
}

TEST_F(Ros2OutputTest, AsksTfWhereTheCameraIs) {
  options_.base_frame = "base_link";
  options_.camera_frame = "camera";
  const Reader tf = reader("/tf", "tf2_msgs/TFMessage");
  Ros2Output output(options_, {});
  output.frame(report_at(1, TrackState::kTracking, Pose::Identity()));
  EXPECT_FALSE(own_transform(tf));
  const Robot robot(participant_);
  Pose forward(Eigen::Translation3d(0.1, 0, 0.4));
  forward.linear() = ros2_messages::map_from_world().linear();
  robot.mount("base_link", "camera", forward);
  output.frame(report_at(2, TrackState::kTracking, Pose(Eigen::Translation3d(0, 0, 2))));
  const auto transform = own_transform(tf);
  ASSERT_TRUE(transform);
  EXPECT_EQ(transform->parent, "map");
  EXPECT_EQ(transform->child, "base_link");
  EXPECT_LT((transform->parent_from_child.translation() - Eigen::Vector3d(2, 0, 0)).norm(), 1e-9);
}

TEST_F(Ros2OutputTest, RefusesFramesThatCannotBeAskedFor) {
  options_.odom_frame = "odom";
  EXPECT_THAT(error_text(Fault::kUsage, [&] { Ros2Output(options_, {}); }),
              HasSubstr("base_frame: is needed with camera_frame or odom_frame"));
  options_.base_frame = "base_link";
  EXPECT_THAT(error_text(Fault::kUsage, [&] { Ros2Output(options_, {}); }),
              HasSubstr("odom_frame: needs to know where the camera is"));
  options_ = {.domain = options_.domain, .base_frame = "base_link"};
  options_.camera_frame = "camera";
  options_.base_from_camera = {0, 0, 1, -0.5, 0.5, -0.5, 0.5};
  EXPECT_THAT(error_text(Fault::kUsage, [&] { Ros2Output(options_, {}); }),
              HasSubstr("give one of both"));
}

TEST_F(Ros2OutputTest, ALostCameraHasAStateAndNoPose) {
  const Reader pose = reader("stillpoint/pose", "geometry_msgs/PoseStamped");
  const Reader state = reader("stillpoint/state", "diagnostic_msgs/DiagnosticStatus");
  Ros2Output output(options_, {});
  output.frame(report_at(1, TrackState::kLost, Pose::Identity()));
  EXPECT_FALSE(taken(pose));
  const auto message = taken(state);
  ASSERT_TRUE(message);
  ByteReader fields(*message, kCdr);
  EXPECT_EQ(fields.number<std::uint8_t>(), 1);  // WARN
  EXPECT_EQ(fields.text(), "stillpoint");
  EXPECT_EQ(fields.text(), "lost");
}

TEST_F(Ros2OutputTest, PublishesAPathOnceASecond) {
  const Reader path = reader("stillpoint/path", "nav_msgs/Path");
  Ros2Output output(options_, {});
  for (int i = 0; i < 20; ++i)
    output.frame(report_at(0.1 * i, TrackState::kTracking, Pose::Identity()));
  std::vector<std::uint32_t> lengths;
  while (const auto message = taken(path)) {
    ByteReader fields(*message, kCdr);
    fields.skip(8);
    EXPECT_EQ(fields.text(), "map");
    lengths.push_back(fields.number<std::uint32_t>());
  }
  EXPECT_EQ(lengths, (std::vector<std::uint32_t>{1, 11}));
}

constexpr const char* kOctree =
    "# Octomap OcTree binary file\nid OcTree\nsize 1\nres 0.05\ndata\nab";

/// A run that can be asked for its dense map only.
class MappingRun final : public LiveRun {
 public:
  Pause pause() override { return nullptr; }
  void step() override {}
  void stop() override {}
  std::optional<std::vector<LabelledPoint>> dense_map() override { return std::nullopt; }
  bool save_dense_map(const std::filesystem::path& directory) override {
    const bool first = saves++ == 0;
    if (disk_is_full) throw Error(Fault::kUsage, "no room left");
    if (first) return false;  // a key frame is being mapped
    std::ofstream(directory / "map.bt", std::ios::binary) << kOctree;
    return true;
  }
  std::filesystem::path map_file() const override { return {}; }
  void save_map() override {}

  bool disk_is_full = false;
  std::atomic<int> saves = 0;
};

TEST_F(Ros2OutputTest, PublishesTheOctreeWhileItGrows) {
  const Reader octomap = reader("stillpoint/octomap", "octomap_msgs/Octomap");
  const auto run = std::make_shared<MappingRun>();
  StageContext context;
  context.deterministic = false;
  Ros2Output output(options_, context);
  output.begin(run);
  std::vector<std::int64_t> stamps;  // ns
  for (double time = 0; stamps.size() < 2 && time < 10'000; time += 0.1) {
    output.frame(report_at(time, TrackState::kTracking, Pose::Identity()));
    if (const auto message = taken(octomap)) stamps.push_back(bag::header_of(*message, kCdr).stamp);
  }
  ASSERT_EQ(stamps.size(), 2U);
  EXPECT_GE(stamps[1] - stamps[0], 4'999'999'000);  // map_period
  EXPECT_EQ(run->saves, 3);
}

TEST_F(Ros2OutputTest, AnOctreeThatCannotBeSavedIsNoReasonToEndTheRun) {
  const Reader octomap = reader("stillpoint/octomap", "octomap_msgs/Octomap");
  const auto run = std::make_shared<MappingRun>();
  run->disk_is_full = true;
  std::string log;
  StageContext context;
  context.deterministic = false;
  context.log = [&](LogLevel, std::string_view text) { log += text; };
  Ros2Output output(options_, context);
  output.begin(run);
  for (double time = 0; run->saves < 2 && time < 10'000; time += 0.1) {
    output.frame(report_at(time, TrackState::kTracking, Pose::Identity()));
    EXPECT_FALSE(taken(octomap));
  }
  EXPECT_EQ(run->saves, 2);
  EXPECT_EQ(log, "octomap and grid cannot be published now: no room left");
}

TEST_F(Ros2OutputTest, PublishesTheMapFilesAtTheEnd) {
  const testing::TemporaryFolder folder;
  folder.write("map.bt", kOctree);
  const Reader octomap = reader("stillpoint/octomap", "octomap_msgs/Octomap");
  Ros2Output output(options_, {});
  poses_.push_back({.time = 1});
  RunSummary run = summary();
  run.map_directory = folder.path();
  output.finish(run);
  const auto message = taken(octomap);
  ASSERT_TRUE(message);
  EXPECT_EQ(bag::header_of(*message, kCdr).frame, "map_optical");
  ByteReader fields(*message, kCdr);
  fields.skip(8);
  fields.text();
  EXPECT_EQ(fields.number<std::uint8_t>(), 1);
  EXPECT_EQ(fields.text(), "OcTree");
  EXPECT_EQ(fields.number<double>(), 0.05);
  EXPECT_EQ(fields.number<std::uint32_t>(), 2U);
}

TEST_F(Ros2OutputTest, AFailureIsAState) {
  const Reader state = reader("stillpoint/state", "diagnostic_msgs/DiagnosticStatus");
  Ros2Output output(options_, {});
  RunSummary run = summary();
  run.failure = "the tracker failed";
  output.finish(run);
  const auto message = taken(state);
  ASSERT_TRUE(message);
  ByteReader fields(*message, kCdr);
  EXPECT_EQ(fields.number<std::uint8_t>(), 2);  // ERROR
  fields.text();
  EXPECT_EQ(fields.text(), "the tracker failed");
}

TEST_F(Ros2OutputTest, RefusesAMountingThatIsNone) {
  for (const std::vector<double>& numbers :
       {std::vector<double>{1, 2, 3}, {0, 0, 0, 0, 0, 0, 0}, {0, 0, 0, 1, 1, 0, 0}}) {
    options_.base_from_camera = numbers;
    EXPECT_THAT(error_text(Fault::kUsage, [&] { Ros2Output(options_, {}); }),
                AllOf(HasSubstr("base_from_camera: needs x, y, z"), HasSubstr("tf2_echo")));
  }
}

}  // namespace
}  // namespace stillpoint::ros2
