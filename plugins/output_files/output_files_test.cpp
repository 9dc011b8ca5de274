#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "output_files/frames_output.hpp"
#include "output_files/image_output.hpp"
#include "output_files/keyframes_output.hpp"
#include "output_files/panels.hpp"
#include "output_files/summary_output.hpp"
#include "output_files/timings_output.hpp"
#include "output_files/trajectory_output.hpp"
#include "support/image_io.hpp"

namespace stillpoint::output_files {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class OutputFiles : public ::testing::Test {
 protected:
  OutputFiles() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    context.output_directory = fs::path(::testing::TempDir()) / "output_files" / test->name();
    fs::remove_all(context.output_directory);
    fs::create_directories(context.output_directory);
  }

  std::vector<std::string> lines(const std::string& file) const {
    std::ifstream stream(context.output_directory / file);
    std::vector<std::string> result;
    for (std::string line; std::getline(stream, line);) result.push_back(line);
    return result;
  }
  std::vector<std::string> files() const {
    std::vector<std::string> result;
    for (const auto& entry : fs::recursive_directory_iterator(context.output_directory))
      result.push_back(fs::relative(entry.path(), context.output_directory).string());
    std::sort(result.begin(), result.end());
    return result;
  }

  RunSummary summary() const {
    return {.map = map, .poses = poses, .source = source, .times = times};
  }

  StageContext context;
  SparseMap map;
  std::vector<TrackedPose> poses;
  SourceReport source;
  std::vector<StageTime> times;
};

Pose at(double x, double y, double z) { return Pose(Eigen::Translation3d(x, y, z)); }

SparseMap map_of(const std::vector<Pose>& keyframe_poses) {
  MapEdit edit({});
  for (std::size_t i = 0; i < keyframe_poses.size(); ++i) {
    KeyFrame keyframe{.id = static_cast<KeyFrameId>(i), .time = 100.0 + static_cast<double>(i)};
    keyframe.world_from_camera = keyframe_poses[i];
    keyframe.features = std::make_shared<const Features>();
    edit.add_keyframe(std::move(keyframe));
    edit.update_covisibility(static_cast<KeyFrameId>(i));
  }
  return std::move(edit).finish();
}

TEST_F(OutputFiles, TrajectoryFollowsItsKeyFramesAndHasTrackedFramesOnly) {
  map = map_of({at(0, 0, 0), at(5, 0, 0)});  // where they ended, not where they were
  poses = {{0, 100.0, TrackState::kTracking, 0, at(0, 0, 0)},
           {1, 100.5, TrackState::kLost, kNoId, Pose::Identity()},
           {2, 101.0, TrackState::kTracking, 1, at(0.25, 0, 0)},
           // Its key frame never reached the map.
           {3, 101.5, TrackState::kTracking, 7, at(0, 0, 0), at(9, 0, 0)}};
  TrajectoryOutput({}, context).finish(summary());
  EXPECT_THAT(
      lines("trajectory.txt"),
      ElementsAre(
          "# time tx ty tz qx qy qz qw",
          "100.000000 0.0000000 0.0000000 0.0000000 0.00000000 0.00000000 0.00000000 1.00000000",
          "101.000000 5.2500000 0.0000000 0.0000000 0.00000000 0.00000000 0.00000000 1.00000000",
          "101.500000 9.0000000 0.0000000 0.0000000 0.00000000 0.00000000 0.00000000 "
          "1.00000000"));
  EXPECT_THAT(files(), ElementsAre("trajectory.txt"));  // nothing temporary is left
}

TEST_F(OutputFiles, TrajectoryFollowsARemovedKeyFrame) {
  MapEdit edit(map_of({at(0, 0, 0), at(5, 0, 0)}));
  edit.remove_keyframe(1);
  edit.keyframe(0).world_from_camera = at(0, 2, 0);
  map = std::move(edit).finish();
  poses = {{2, 101.0, TrackState::kTracking, 1, at(0.25, 0, 0)}};
  TrajectoryOutput({}, context).finish(summary());
  EXPECT_THAT(lines("trajectory.txt").at(1), HasSubstr("101.000000 5.2500000 2.0000000 "));
}

TEST_F(OutputFiles, KeyFramesAreThoseOfTheFinishedMap) {
  MapEdit edit(map_of({at(0, 0, 0), at(5, 0, 0), at(0, 0, 3)}));
  edit.remove_keyframe(1);
  map = std::move(edit).finish();
  KeyFramesOutput({}, context).finish(summary());
  const auto written = lines("keyframes.txt");
  ASSERT_EQ(written.size(), 3u);
  EXPECT_THAT(written[2], HasSubstr("102.000000 0.0000000 0.0000000 3.0000000 "));
}

struct Report {
  Frame frame{.index = 60, .time = 1.5, .bgr = cv::Mat(120, 160, CV_8UC3, cv::Scalar(90, 90, 90))};
  Segmentation segmentation;
  MovingPoints moving;
  MapEvidence evidence;
  StaticWeights weights;
  TrackResult result;
  std::vector<StageTime> times{{"track", 10.0, 8.0, 60}, {"map_refine", 50.0, 49.0, 48}};
  FrameReport operator()() const {
    return {.frame = std::make_shared<const Frame>(frame),
            .segmentation = std::make_shared<const Segmentation>(segmentation),
            .moving = moving,
            .evidence = evidence,
            .weights = std::make_shared<const StaticWeights>(weights),
            .result = result,
            .times = times};
  }
};

TEST_F(OutputFiles, TimingsAreStreamedAndComplete) {
  TimingsOutput output({}, context);
  EXPECT_THAT(files(), ElementsAre(::testing::MatchesRegex("timings.csv.[0-9]+-[0-9]+.part")));
  output.frame(Report()());
  times = {{"loop", 1.0, 0.5, 59}};
  output.finish(summary());
  EXPECT_THAT(lines("timings.csv"),
              ElementsAre("frame,stage,wall_ms,cpu_ms", "60,track,10.0000,8.0000",
                          "48,map_refine,50.0000,49.0000", "59,loop,1.0000,0.5000"));
}

TEST_F(OutputFiles, FramesSayWhatTrackingHadAndWhatItLeftOut) {
  Report report;
  FramesOutput output({}, context);
  output.frame(report());  // no weights: all of the image is used
  report.frame.index = 61;
  report.frame.time = 1.533333;
  report.result = {.state = TrackState::kTracking, .features = 900, .matches = 200, .inliers = 150};
  report.moving = {.points = {{{1, 1}, {2, 2}, 3.0F, true}, {{5, 5}, {5, 5}, 0.0F, false}},
                   .reliable = true};
  report.weights.track = cv::Mat(120, 160, CV_8UC1, cv::Scalar(255));
  report.weights.track.colRange(0, 40) = 0;
  output.frame(report());
  output.finish(summary());
  EXPECT_THAT(
      lines("frames.csv"),
      ElementsAre("frame,time,state,features,matches,inliers,moving_points,excluded_percent",
                  "60,1.500000,waiting,0,0,0,,0.00", "61,1.533333,tracking,900,200,150,1,25.00"));
}

TEST_F(OutputFiles, UnfinishedFilesLeaveNothingBehind) {
  { TimingsOutput output({}, context); }
  EXPECT_TRUE(files().empty());
}

TEST_F(OutputFiles, SummaryIsJsonWithTheFiguresOfTheRun) {
  map = map_of({at(0, 0, 0), at(5, 0, 0)});
  const auto pose = [](std::uint32_t i, TrackState state) {
    return TrackedPose{.frame = i, .time = 0.1 * i, .state = state};
  };
  poses = {pose(0, TrackState::kWaiting),  pose(1, TrackState::kTracking),
           pose(2, TrackState::kTracking), pose(3, TrackState::kLost),
           pose(4, TrackState::kLost),     pose(5, TrackState::kTracking)};
  source = {.skipped = 3, .warnings = {"depth/\xff.png: \"unreadable\""}};
  SummaryOutput output({}, context);
  output.frame(Report()());
  RunSummary run = summary();
  run.dropped_frames = 4;
  run.dropped_reports = 6;
  run.loops_closed = 2;
  run.cpu_seconds = 0.6;
  run.seed = 42;
  run.mode = "inline";
  run.complete = false;
  run.failure = "tracking (orb) failed on frame 6: …";
  output.finish(run);

  std::ifstream stream(context.output_directory / "summary.json");
  const auto json = nlohmann::json::parse(stream);
  EXPECT_EQ(json["frames"], 10);
  EXPECT_EQ(json["processed_frames"], 6);
  EXPECT_EQ(json["tracked_frames"], 3);
  EXPECT_EQ(json["dropped_frames"], 4);
  EXPECT_EQ(json["dropped_reports"], 6);
  EXPECT_EQ(json["loops_closed"], 2);
  EXPECT_DOUBLE_EQ(json["coverage"], 0.3);
  EXPECT_EQ(json["times_lost"], 1);
  EXPECT_EQ(json["keyframes"], 2);
  EXPECT_EQ(json["skipped_images"], 3);
  EXPECT_DOUBLE_EQ(json["cpu_ms_per_frame"], 100.0);
  EXPECT_EQ(json["seed"], 42);
  EXPECT_EQ(json["mode"], "inline");
  EXPECT_EQ(json["complete"], false);
  EXPECT_EQ(json["failure"], run.failure);
  EXPECT_GT(json["peak_memory_mib"], 1.0);
  EXPECT_EQ(json["stages"]["track"]["count"], 1);
  EXPECT_DOUBLE_EQ(json["stages"]["track"]["wall_ms"]["p95"], 10.0);
  EXPECT_EQ(json["versions"]["opencv"], CV_VERSION);
}

TEST(Distribution, PercentilesOfAKnownSeries) {
  std::vector<float> values;
  for (int i = 100; i >= 1; --i) values.push_back(static_cast<float>(i));
  const Distribution d = distribution_of(values);
  EXPECT_DOUBLE_EQ(d.mean, 50.5);
  EXPECT_DOUBLE_EQ(d.p50, 50.0);
  EXPECT_DOUBLE_EQ(d.p95, 95.0);
  EXPECT_DOUBLE_EQ(d.p99, 99.0);
  EXPECT_DOUBLE_EQ(d.max, 100.0);
  EXPECT_DOUBLE_EQ(distribution_of({}).max, 0.0);
  EXPECT_DOUBLE_EQ(distribution_of({7.0f}).p50, 7.0);
}

TEST_F(OutputFiles, PicturesAreMadeOfEveryNthFrame) {
  std::filesystem::create_directories(context.output_directory / "images");
  std::ofstream(context.output_directory / "images/000010.jpg") << "of an earlier run";
  ImageOutput output({.every = 20, .format = ImageOutput::Options::Format::kPng}, context);
  Report report;
  output.frame(report());
  report.frame.index = 61;
  output.frame(report());
  EXPECT_THAT(files(), ElementsAre("images", "images/000060.png"));
  const cv::Mat picture = testing::read_image((context.output_directory / "images/000060.png"));
  EXPECT_EQ(picture.size(), report.frame.bgr.size());
}

TEST_F(OutputFiles, FramesThatAreAskedForAndTheWorstHavePicturesToo) {
  ImageOutput output({.every = 1000, .frames = {7, 305}, .worst = 2}, context);
  Report report;
  report.weights.track = cv::Mat(120, 160, CV_8UC1, cv::Scalar(255));
  for (std::uint32_t i = 0; i < 400; ++i) {
    report.frame.index = i;
    report.frame.time = i / 30.0;
    const bool lost = i == 250 || i == 251;
    report.result = {
        .state = lost ? TrackState::kLost : TrackState::kTracking,
        .matches = 200,
        .inliers = 150 - (i == 100 ? 50 : 0) - (i == 160 ? 60 : 0) - (i == 161 ? 55 : 0)};
    const int columns = i == 20 ? 20 : i == 60 ? 40 : i == 305 ? 60 : i == 390 ? 30 : 0;
    report.weights.track.setTo(255);
    if (columns > 0) report.weights.track.colRange(0, columns) = 0;
    output.frame(report());
  }
  output.finish(summary());
  // 20 was one of the two with most excluded, until 60 and 305 had more; 161 is beside 160.
  EXPECT_THAT(files(), ElementsAre("images", "images/000000.jpg", "images/000007.jpg",
                                   "images/000060.jpg", "images/000100.jpg", "images/000160.jpg",
                                   "images/000250.jpg", "images/000305.jpg"));
}

TEST_F(OutputFiles, APictureStaysAsLongAsItIsTheWorstOfAnyKind) {
  ImageOutput output({.every = 1000, .worst = 1}, context);
  Report report;
  for (const std::uint32_t i : {10U, 50U}) {
    report.frame.index = i;
    report.frame.time = i / 30.0;
    report.result = {.state = TrackState::kTracking, .matches = 90, .inliers = i == 10 ? 20 : 80};
    report.weights.track = cv::Mat(120, 160, CV_8UC1, cv::Scalar(i == 10 ? 200 : 100));
    output.frame(report());
  }
  output.finish(summary());
  EXPECT_THAT(files(), ElementsAre("images", "images/000010.jpg", "images/000050.jpg"));
}

TEST(Annotation, DrawsEachPartAndLeavesTheFrameAlone) {
  Report report;
  const cv::Mat before = report.frame.bgr.clone();
  report.segmentation.labels = cv::Mat::zeros(120, 160, CV_8UC1);
  report.segmentation.labels(cv::Rect(10, 10, 40, 40)) = 15;
  report.weights.track = cv::Mat(120, 160, CV_8UC1, cv::Scalar(255));
  report.weights.track(cv::Rect(10, 10, 20, 40)) = 0;
  report.moving.points = {{{70.f, 20.f}, {80.f, 25.f}, 3.f, true}};
  report.result.tracked = {{{120.f, 20.f}, TrackedFeature::Use::kInlier}};
  const cv::Mat picture = annotated(report(), {.text = false});
  const auto pixel = [&](int x, int y) { return picture.at<cv::Vec3b>(y, x); };
  EXPECT_GT(pixel(20, 30)[2], pixel(20, 30)[0]);    // not used: red
  EXPECT_GT(pixel(40, 30)[0], pixel(40, 30)[2]);    // used: blue
  EXPECT_GT(pixel(120, 20)[1], pixel(120, 20)[2]);  // an inlier: green
  EXPECT_GT(pixel(80, 25)[2], pixel(80, 25)[0]);    // a moving point: orange
  EXPECT_EQ(pixel(150, 100), cv::Vec3b(90, 90, 90));
  EXPECT_EQ(cv::norm(before, report.frame.bgr), 0.0);
}

TEST(Panels, ShowWhatIsUsedBesideTheLabels) {
  Report report;
  report.segmentation.labels = cv::Mat::zeros(120, 160, CV_8UC1);
  report.segmentation.labels(cv::Rect(10, 40, 40, 40)) = 15;
  report.segmentation.objects = {{.label = 15, .box = {10, 40, 40, 40}}};
  report.weights.track = cv::Mat(120, 160, CV_8UC1, cv::Scalar(255));
  report.weights.track(cv::Rect(10, 40, 40, 40)) = 0;
  report.weights.object_moves = {true};
  const cv::Mat picture = panels_of(report());
  ASSERT_EQ(picture.size(), cv::Size(320, 240));
  const auto pixel = [&](int x, int y) { return picture.at<cv::Vec3b>(y, x); };
  EXPECT_EQ(pixel(20, 70), cv::Vec3b(90, 90, 90));            // features: no mask
  EXPECT_GT(pixel(14, 120 + 70)[2], pixel(14, 120 + 70)[0]);  // labels: not used, red
  EXPECT_LT(pixel(160 + 20, 120 + 70)[0], 20);                // used: dark where it is not
  EXPECT_EQ(pixel(160 + 100, 120 + 70), cv::Vec3b(90, 90, 90));
}

TEST(Annotation, TakesFramesWithoutAnythingAndOnePixelImages) {
  Report report;
  EXPECT_FALSE(annotated(report(), {}).empty());
  EXPECT_FALSE(panels_of(report()).empty());
  report.frame.bgr = cv::Mat(1, 1, CV_8UC3, cv::Scalar(0));
  EXPECT_EQ(annotated(report(), {}).size(), cv::Size(1, 1));
}

TEST_F(OutputFiles, AFolderThatCannotBeMadeIsAUsageError) {
  std::ofstream(context.output_directory / "images") << "a file";
  try {
    ImageOutput({}, context);
    FAIL() << "no exception";
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kUsage);
    EXPECT_THAT(error.what(), HasSubstr("images"));
  }
}

TEST_F(OutputFiles, AFileThatCannotBeWrittenIsAUsageError) {
  fs::create_directory(context.output_directory / "trajectory.txt");
  try {
    TrajectoryOutput({}, context).finish(summary());
    FAIL() << "no exception";
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kUsage);
    EXPECT_THAT(error.what(), HasSubstr("trajectory.txt"));
  }
  EXPECT_THAT(files(), ElementsAre("trajectory.txt"));
}

}  // namespace
}  // namespace stillpoint::output_files
