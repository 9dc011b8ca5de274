#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <stillpoint/testing/test_recording.hpp>
#include <thread>

#include "output_web/access.hpp"
#include "output_web/map_changes.hpp"
#include "output_web/page.hpp"
#include "output_web/picture.hpp"
#include "output_web/request.hpp"
#include "output_web/test_viewer.hpp"
#include "output_web/truth.hpp"
#include "output_web/web_output.hpp"

namespace stillpoint::output_web {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;
using ::testing::StartsWith;

using Bytes = std::vector<std::uint8_t>;

TEST(Request, IsThreeBytesAndNothingElse) {
  const auto request = parse_request(Bytes{kProtocol, 1, 5});
  ASSERT_TRUE(request);
  EXPECT_TRUE(request->image);
  EXPECT_FALSE(request->map);
  EXPECT_TRUE(request->cloud);
  for (const Bytes& wrong :
       {Bytes{}, Bytes{kProtocol}, Bytes{kProtocol, 1}, Bytes{kProtocol, 1, 1, 0},
        Bytes{kProtocol + 1, 1, 1}, Bytes{kProtocol, 2, 1}, Bytes{kProtocol, 1, 8}})
    EXPECT_FALSE(parse_request(wrong)) << wrong.size();
}

TEST(Access, OfThisMachineAloneNeedsItsNames) {
  const Access access("127.0.0.1", "");
  for (const char* host :
       {"localhost", "localhost:8080", "127.0.0.1:9999", "[::1]:80", "127.1.2.3"})
    EXPECT_THAT(access.refusal({.target = "/", .host = host}), IsEmpty()) << host;
  for (const char* host : {"", "evil.example", "evil.example:8080", "localhost.evil.example", "[",
                           "192.168.1.2:8080", "127.0.0.1.evil.example"})
    EXPECT_THAT(access.refusal({.target = "/", .host = host}), Not(IsEmpty())) << host;
}

TEST(Access, IsForPagesOfTheServerItself) {
  const Access access("127.0.0.1", "");
  const auto refusal = [&](const char* origin) {
    return access.refusal({.target = "/live", .host = "localhost:9000", .origin = origin});
  };
  EXPECT_THAT(refusal("http://localhost:9000"), IsEmpty());
  EXPECT_THAT(refusal("https://localhost:9000"), IsEmpty());  // behind a proxy
  for (const char* origin : {"http://evil.example", "http://localhost:9001", "http://localhost",
                             "null", "file://", "http://localhost:9000.evil.example"})
    EXPECT_THAT(refusal(origin), HasSubstr("other sites")) << origin;
}

TEST(Access, FromElsewhereNeedsTheToken) {
  const Access access("0.0.0.0", "s3cret");
  const auto refusal = [&](const char* target) {
    return access.refusal({.target = target, .host = "robot:8080"});
  };
  for (const char* target : {"/?token=s3cret", "/live?a=b&token=s3cret", "/?token=s3cret&x"})
    EXPECT_THAT(refusal(target), IsEmpty()) << target;
  for (const char* target : {"/", "/?", "/?token=", "/?token=s3cre", "/?token=s3cretx", "/?&&token",
                             "/?xtoken=s3cret", "/s3cret"})
    EXPECT_THAT(refusal(target), HasSubstr("token")) << target;
}

TEST(Access, TokensAreLongAndDiffer) {
  EXPECT_THAT(random_token(), SizeIs(32));
  EXPECT_NE(random_token(), random_token());
}

TEST(Truth, IsBetweenItsNeighbours) {
  const Truth truth({1.0, 1.05, 3.0}, {{0, 0, 0}, {1, 2, 3}, {9, 9, 9}});
  EXPECT_TRUE(truth.position_at(1.0)->isApprox(Eigen::Vector3d(0, 0, 0)));
  EXPECT_TRUE(truth.position_at(1.025)->isApprox(Eigen::Vector3d(0.5, 1, 1.5)));
  EXPECT_FALSE(truth.position_at(0.9));
  EXPECT_FALSE(truth.position_at(2.0));  // a gap
  EXPECT_FALSE(truth.position_at(3.1));
  EXPECT_FALSE(Truth().known());
}

TEST(Truth, FitsUpToARigidMotion) {
  const Pose motion = Eigen::Translation3d(1, -2, 3) *
                      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized());
  const std::vector<Eigen::Vector3d> truth = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 2}};
  std::vector<Eigen::Vector3d> estimate;
  for (const Eigen::Vector3d& point : truth) estimate.emplace_back(motion * point);
  const auto fit = fit_truth(truth, estimate);
  ASSERT_TRUE(fit);
  EXPECT_TRUE(fit->world_from_truth.isApprox(motion, 1e-9));
  EXPECT_NEAR(fit->rmse_m, 0, 1e-9);
  EXPECT_FALSE(fit_truth({{0, 0, 0}, {1, 0, 0}}, {{0, 0, 0}, {1, 0, 0}}));
}

TEST(Truth, ComesFromTheRecording) {
  const fs::path folder = fs::path(::testing::TempDir()) / "output_web_truth";
  fs::create_directories(folder);
  std::ofstream(folder / "groundtruth.txt")
      << "# time tx ty tz qx qy qz qw\n2 1 1 1 0 0 0 1\nno pose\n1 nan 0 0\n1 0 0 0 0 0 0 1\n";
  EXPECT_TRUE(Truth::beside(folder).position_at(1)->isZero());
  EXPECT_TRUE(Truth::beside(folder).position_at(2)->isOnes());
  EXPECT_FALSE(Truth::beside(folder / "none").known());
  EXPECT_FALSE(Truth::beside("").known());
  fs::remove_all(folder);
}

KeyFrame keyframe_at(KeyFrameId id, double x) {
  KeyFrame keyframe{.id = id, .frame = 10 * id};
  keyframe.world_from_camera.translation().x() = x;
  keyframe.features = std::make_shared<const Features>(
      Features{.keypoints = {{}}, .descriptors = {{}}, .depth = {1}});
  keyframe.track_weights = keyframe.map_weights = {255};
  keyframe.landmarks = {kNoId};
  return keyframe;
}

SparseMap map_of_three() {
  MapEdit edit({});
  for (KeyFrameId id = 0; id < 3; ++id) edit.add_keyframe(keyframe_at(id, id));
  const LandmarkId landmark =
      edit.add_landmark({.position_in_world = {1, 2, 3}, .reference = 0, .static_log_odds = -1});
  for (KeyFrameId id = 0; id < 3; ++id) edit.add_observation(landmark, {id, 0});
  edit.add_landmark({.position_in_world = {4, 5, 6}, .reference = 0});
  for (KeyFrameId id = 0; id < 3; ++id) edit.update_covisibility(id, 1);
  return std::move(edit).finish();
}

Records changes(const SparseMap& before, const SparseMap& after) {
  MessageWriter writer;
  writer.number(kProtocol);
  write_map_changes(before, after, writer);
  return records_of(writer.take());
}

TEST(MapChanges, OfAnEmptyMapAreAllOfIt) {
  Records records = changes({}, map_of_three());
  const std::string keyframes = records[Record::kKeyFrames].at(0);
  EXPECT_EQ(number_at<std::uint32_t>(keyframes, 0), 3u);
  // Id, presence, pose, frame and parent of the first, which has no edges to older ones.
  EXPECT_EQ(number_at<std::uint32_t>(keyframes, 4 + 4 + 1 + 28 + 8), 0u);
  const std::size_t second = 4 + 4 + 1 + 28 + 8 + 4;
  EXPECT_EQ(number_at<std::uint32_t>(keyframes, second), 1u);
  EXPECT_EQ(number_at<float>(keyframes, second + 5), 1.f);       // x
  EXPECT_EQ(number_at<float>(keyframes, second + 5 + 24), 1.f);  // w of no rotation
  EXPECT_EQ(number_at<std::uint32_t>(keyframes, second + 33), 10u);
  EXPECT_EQ(number_at<std::uint32_t>(keyframes, second + 41), 1u);  // one edge
  EXPECT_EQ(number_at<std::uint32_t>(keyframes, second + 45), 0u);  // to the first
  EXPECT_EQ(number_at<std::uint16_t>(keyframes, second + 49), 1u);  // by one landmark
  const std::string landmarks = records[Record::kLandmarks].at(0);
  ASSERT_EQ(number_at<std::uint32_t>(landmarks, 0), 2u);
  EXPECT_EQ(number_at<float>(landmarks, 4 + 4 + 8), 3.f);
  EXPECT_EQ(number_at<std::int8_t>(landmarks, 4 + 16), -8);
  EXPECT_EQ(number_at<std::uint8_t>(landmarks, 4 + 17), 3);
}

std::vector<std::uint32_t> counts(Records records) {
  return {number_at<std::uint32_t>(records[Record::kKeyFrames].at(0), 0),
          number_at<std::uint32_t>(records[Record::kLandmarks].at(0), 0)};
}

TEST(MapChanges, AreWhatHasChangedOnly) {
  const SparseMap before = map_of_three();
  EXPECT_THAT(counts(changes(before, before)), ::testing::ElementsAre(0, 0));

  MapEdit moved(before);
  moved.keyframe(1).world_from_camera.translation().y() = 2;
  moved.landmark(1).position_in_world.x() = 0;
  const SparseMap after = std::move(moved).finish();
  EXPECT_THAT(counts(changes(before, after)), ::testing::ElementsAre(1, 1));

  MapEdit evidence(before);
  ++evidence.landmark(0).visible;  // nobody sees this
  EXPECT_THAT(counts(changes(before, std::move(evidence).finish())), ::testing::ElementsAre(0, 0));
}

TEST(MapChanges, TellWhereARemovedKeyFrameStandsAndThatALandmarkIsGone) {
  const SparseMap before = map_of_three();
  MapEdit edit(before);
  edit.remove_keyframe(2);
  edit.remove_landmark(1);
  const SparseMap removed = std::move(edit).finish();
  Records records = changes(before, removed);
  const std::string& landmarks = records[Record::kLandmarks].at(0);
  EXPECT_EQ(number_at<std::uint8_t>(landmarks, landmarks.size() - 1), 0);  // observations
  const std::string& keyframes = records[Record::kKeyFrames].at(0);
  const std::size_t last = keyframes.size() - 33;
  EXPECT_EQ(number_at<std::uint32_t>(keyframes, last), 2u);
  EXPECT_EQ(number_at<std::uint8_t>(keyframes, last + 4), 0);
  EXPECT_EQ(number_at<float>(keyframes, last + 5), 2.f);

  MapEdit moving(removed);  // a removed one moves with its parent
  for (const KeyFrameId id : {0u, 1u}) moving.keyframe(id).world_from_camera.translation().y() = 7;
  records = changes(removed, std::move(moving).finish());
  const std::string& moved = records[Record::kKeyFrames].at(0);
  EXPECT_EQ(number_at<std::uint32_t>(moved, 0), 3u);
  EXPECT_EQ(number_at<float>(moved, moved.size() - 33 + 9), 7.f);
}

const testing::TestRecording& recording() {
  static const testing::TestRecording kRecording({.frames = 4});
  return kRecording;
}

FrameReport report_of(std::size_t i) {
  FrameReport report{.frame = recording().frame(i),
                     .segmentation = recording().segmentation(i),
                     .moving = recording().moving_points(i),
                     .weights = recording().weights(i),
                     .times = {{"track", 5, 4, static_cast<std::uint32_t>(i)}},
                     .map = std::make_shared<const SparseMap>()};
  report.result.state = TrackState::kTracking;
  report.result.reference = 0;
  report.result.world_from_camera = recording().world_from_camera(i);
  report.result.reference_from_camera = recording().world_from_camera(i);
  report.result.features = 1000;
  report.result.inliers = 400;
  report.result.tracked = {{{20.5f, 10.f}, TrackedFeature::Use::kInlier}};
  if (i == 0) report.result.keyframe = recording().keyframe(0, 0);
  return report;
}

TEST(Picture, TellsWhyFeaturesAreNotUsed) {
  FrameReport report = report_of(1);
  const SegmentedObject& person = recording().segmentation(1)->objects.at(0);
  const cv::Mat& labels = report.segmentation->labels;
  cv::Point inside;
  for (int v = 0; v < labels.rows; ++v)
    for (int u = 0; u < labels.cols; ++u)
      if (labels.at<std::uint8_t>(v, u) == person.label) inside = {u, v};
  auto weights = std::make_shared<StaticWeights>(*report.weights);
  weights->object_moves = {true};
  report.weights = weights;
  report.moving.points = {};
  report.result.tracked = {{cv::Point2f(inside), TrackedFeature::Use::kMoving},
                           {{1, 2}, TrackedFeature::Use::kUnmatched}};
  MessageWriter writer;
  writer.number(kProtocol);
  writer.text(picture_of(report));
  Records records = records_of(writer.take());
  const std::string& features = records[Record::kFeatures].at(0);
  ASSERT_EQ(features.size(), 2 * 7u);
  EXPECT_EQ(number_at<std::uint16_t>(features, 0), 8 * inside.x);
  EXPECT_EQ(number_at<std::uint8_t>(features, 4), 3);             // moving
  EXPECT_EQ(number_at<std::uint8_t>(features, 5), person.label);  // its class
  EXPECT_EQ(number_at<std::uint8_t>(features, 6), 1 | 2 | 16);    // why
  EXPECT_EQ(number_at<std::uint8_t>(features, 7 + 6), 0);

  const std::string& image = records[Record::kImage].at(0);
  EXPECT_EQ(number_at<std::uint32_t>(image, 0), 1u);
  const std::vector<char> jpeg(image.begin() + 4, image.end());
  EXPECT_EQ(cv::imdecode(jpeg, cv::IMREAD_COLOR).size(), report.frame->bgr.size());

  const std::string& mask = records[Record::kMask].at(0);
  std::size_t pixels = 0, unused = 0;
  for (std::size_t at = 4; at < mask.size(); at += 4) {
    pixels += number_at<std::uint16_t>(mask, at + 2);
    if (number_at<std::uint8_t>(mask, at + 1)) unused += number_at<std::uint16_t>(mask, at + 2);
  }
  EXPECT_EQ(pixels, 160u * 120u);
  EXPECT_NEAR(static_cast<double>(unused), person.pixels / 4.0, person.pixels / 20.0);
}

TEST(Picture, OfSurfacesLeavesOutWhatIsKeptOutOfTheMap) {
  MessageWriter writer;
  writer.number(kProtocol);
  writer.text(cloud_of(report_of(2), 7));
  const std::string cloud = records_of(writer.take())[Record::kCloud].at(0);
  EXPECT_EQ(number_at<std::uint32_t>(cloud, 0), 7u);
  EXPECT_EQ(number_at<std::uint16_t>(cloud, 6), 40);
  EXPECT_EQ(number_at<std::uint16_t>(cloud, 8), 30);
  ASSERT_EQ(cloud.size(), 10u + 6 * 40 * 30);
  const Frame& frame = *recording().frame(2);
  for (int row = 0; row < 30; ++row)
    for (int column = 0; column < 40; ++column) {
      const cv::Point pixel(8 * column + 4, 8 * row + 4);
      const bool used = recording().weights(2)->map.at<std::uint8_t>(pixel) == 255;
      const double depth = used ? 1000 * frame.depth.at<float>(pixel) : 0;
      EXPECT_NEAR(number_at<std::uint16_t>(cloud, 10 + 6 * (40 * row + column)), depth, 1) << pixel;
    }
}

class LiveView : public ::testing::Test {
 protected:
  std::unique_ptr<WebOutput> make(const WebOutput::Options& options) const {
    return std::make_unique<WebOutput>(options, testing::test_context());
  }
  static std::uint16_t port(const WebOutput& output) { return port_of(output.url()); }
  static void finish(WebOutput& output) {
    const SparseMap map;
    const std::vector<TrackedPose> poses;
    const SourceReport source;
    const std::vector<StageTime> times;
    output.finish({.map = map, .poses = poses, .source = source, .times = times});
  }

  std::unique_ptr<WebOutput> output = make({.port = 0});
};

TEST_F(LiveView, HasAPageThatLoadsNothingFromElsewhere) {
  const std::string answer = get(port(*output), "/");
  EXPECT_THAT(answer, StartsWith("HTTP/1.1 200 OK"));
  EXPECT_THAT(answer, HasSubstr("<title>Stillpoint"));
  EXPECT_THAT(answer, HasSubstr("default-src 'none'"));
  EXPECT_THAT(get(port(*output), "/index.html"), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(answer_to(port(*output), "HEAD / HTTP/1.1\r\nHost: localhost\r\n\r\n"),
              ::testing::EndsWith("\r\n\r\n"));
  EXPECT_THAT(answer_to(port(*output), "PUT / HTTP/1.1\r\nHost: localhost\r\n\r\n"),
              StartsWith("HTTP/1.1 405"));
}

TEST_F(LiveView, ShowsARunFromItsBeginning) {
  output->frame(report_of(0));
  output->frame(report_of(1));
  TestViewer viewer(port(*output));
  const auto records = viewer.asked();
  ASSERT_TRUE(records);
  const auto hello = nlohmann::json::parse(records->at(Record::kHello).at(0));
  EXPECT_EQ(hello["camera"]["width"], 320);
  EXPECT_EQ(hello["classes"][1]["name"], "person");
  EXPECT_EQ(records->at(Record::kStages).at(0).substr(1), "track");
  EXPECT_EQ(number_at<float>(records->at(Record::kTimes).at(0), 5), 5.f);
  const std::string& frames = records->at(Record::kFrames).at(0);
  ASSERT_EQ(frames.size() % 2, 0u);
  const std::size_t second = frames.size() / 2;
  EXPECT_EQ(number_at<std::uint32_t>(frames, second), 1u);
  EXPECT_DOUBLE_EQ(number_at<double>(frames, second + 4), recording().frame(1)->time);
  EXPECT_EQ(number_at<std::uint8_t>(frames, 13), 1);  // a key frame
  EXPECT_NEAR(number_at<float>(frames, second + 18),
              recording().world_from_camera(1).translation().x(), 1e-6);
  EXPECT_EQ(number_at<std::uint16_t>(frames, second + 18 + 56), 1000);
  EXPECT_EQ(number_at<std::uint32_t>(records->at(Record::kImage).at(0), 0), 1u);
  EXPECT_EQ(records->count(Record::kCloud), 1u);
}

TEST_F(LiveView, SendsWhatIsNewAndAskedFor) {
  output->frame(report_of(0));
  TestViewer viewer(port(*output));
  ASSERT_TRUE(viewer.asked(2));
  viewer.ask(2);
  output->frame(report_of(1));
  auto records = viewer.next();
  ASSERT_TRUE(records);
  EXPECT_EQ(number_at<std::uint32_t>(records->at(Record::kFrames).at(0), 0), 1u);
  for (const Record none : {Record::kHello, Record::kStages, Record::kImage, Record::kCloud})
    EXPECT_FALSE(records->contains(none)) << static_cast<int>(none);
  records = viewer.asked(5);  // now the rest, without a new frame
  ASSERT_TRUE(records);
  EXPECT_TRUE(records->contains(Record::kCloud));
  EXPECT_FALSE(records->contains(Record::kFrames));
}

TEST_F(LiveView, TellsOfLoops) {
  FrameReport report = report_of(0);
  report.map = std::make_shared<const SparseMap>(map_of_three());
  output->frame(report);
  MapEdit edit(map_of_three());
  edit.keyframe(2).world_from_camera.translation().x() += 0.5;
  report = report_of(1);
  report.map = std::make_shared<const SparseMap>(std::move(edit).finish());
  report.loops_closed = 1;
  output->frame(report);
  TestViewer viewer(port(*output));
  const auto records = viewer.asked();
  ASSERT_TRUE(records);
  const std::string& loop = records->at(Record::kLoops).at(0);
  EXPECT_EQ(number_at<std::uint32_t>(loop, 0), 1u);
  EXPECT_EQ(number_at<std::uint32_t>(loop, 4), 1u);
  EXPECT_FLOAT_EQ(number_at<float>(loop, 8), 0.5f);
}

TEST_F(LiveView, SaysHowTheRunHasEndedThenGoodBye) {
  output->frame(report_of(0));
  TestViewer viewer(port(*output)), late(port(*output));
  ASSERT_TRUE(viewer.asked());
  viewer.ask();
  finish(*output);
  const auto records = viewer.next();
  ASSERT_TRUE(records);
  EXPECT_TRUE(nlohmann::json::parse(records->at(Record::kEnd).at(0))["complete"]);
  std::thread end([&] { output.reset(); });
  EXPECT_FALSE(viewer.next());
  EXPECT_EQ(viewer.close_code(), 1001);
  const auto unasked = late.next();  // who has not asked gets it as well
  ASSERT_TRUE(unasked);
  EXPECT_TRUE(unasked->contains(Record::kEnd));
  EXPECT_FALSE(late.next());
  end.join();
}

TEST_F(LiveView, ServesOthersWhileOneDoesNotRead) {
  TestViewer hanging(port(*output)), viewer(port(*output));
  hanging.ask();
  for (int round = 0; round < 50; ++round) {
    FrameReport report = report_of(1);
    auto frame = std::make_shared<Frame>(*report.frame);
    frame->index = static_cast<std::uint32_t>(round);
    report.frame = frame;
    output->frame(report);
    ASSERT_TRUE(viewer.asked()) << round;
  }
  finish(*output);
  output.reset();  // does not wait for it
}

TEST_F(LiveView, StartsAnewForWhoComesAgain) {
  output->frame(report_of(0));
  for (int visit = 0; visit < 3; ++visit) {
    TestViewer viewer(port(*output));
    const auto records = viewer.asked();
    ASSERT_TRUE(records);
    EXPECT_TRUE(records->contains(Record::kHello));
    EXPECT_TRUE(records->contains(Record::kFrames));
  }
}

TEST_F(LiveView, ClosesOnWhatNoPageOfItsOwnSays) {
  output->frame(report_of(0));
  for (const std::string& wrong : {std::string("x"), std::string(), std::string("\x01\x01\xff", 3),
                                   std::string("\x02\x01\x07", 3)}) {
    TestViewer viewer(port(*output));
    viewer.send(wrong);
    EXPECT_FALSE(viewer.next());
    EXPECT_EQ(viewer.close_code(), 1008) << wrong.size();
  }
  TestViewer greedy(port(*output));
  ASSERT_TRUE(greedy.asked());
  greedy.ask();
  greedy.ask();  // before there is an answer
  EXPECT_FALSE(greedy.next());
  TestViewer large(port(*output));
  large.send(std::string(100, 'x'));
  EXPECT_FALSE(large.next());
  EXPECT_EQ(large.close_code(), 1009);  // too big
  EXPECT_TRUE(TestViewer(port(*output)).asked());
}

TEST_F(LiveView, SurvivesGarbage) {
  output->frame(report_of(0));
  const std::string upgrade =
      "GET /live HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
      "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";
  const std::string huge_length =
      "\x82\xff\x7f\xff\xff\xff\xff\xff\xff\xff"
      "mask";
  for (const std::string& garbage :
       {std::string("\r\n\r\n"), std::string("\0\xff\x16\x03\x01", 5) + "\r\n\r\n",
        "GET / HTTP/1.1\r\nHost: localhost\r\nX: " + std::string(100'000, 'x') + "\r\n\r\n",
        std::string("POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 99999999999\r\n\r\n"),
        std::string("GET /live HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: "
                    "Upgrade\r\n\r\n"),
        upgrade + huge_length, upgrade + "\x82\x03\x01\x01\x07"}) {  // the last one is not masked
    const std::string answer = answer_to(port(*output), garbage);
    EXPECT_THAT(answer, Not(HasSubstr("200 OK"))) << garbage.substr(0, 20);
  }
  { TestConnection silent(port(*output)); }
  EXPECT_TRUE(TestViewer(port(*output)).asked());
}

TEST_F(LiveView, RefusesPagesOfOthers) {
  EXPECT_THAT(get(port(*output), "/live",
                  "Host: localhost\r\nOrigin: http://evil.example\r\nUpgrade: websocket\r\n"
                  "Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                  "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"),
              StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(get(port(*output), "/", "Host: evil.example\r\n"), StartsWith("HTTP/1.1 403"));
}

TEST_F(LiveView, WantsTheTokenWhereThereIsOne) {
  const auto guarded = make({.port = 0, .token = "s3cret"});
  guarded->frame(report_of(0));
  EXPECT_THAT(guarded->url(), ::testing::EndsWith("/?token=s3cret"));
  EXPECT_THAT(get(port(*guarded), "/"), StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(get(port(*guarded), "/?token=s3cret"), StartsWith("HTTP/1.1 200"));
  EXPECT_THROW(TestViewer(port(*guarded), "/live?token=guess"), boost::system::system_error);
  EXPECT_TRUE(TestViewer(port(*guarded), "/live?token=s3cret").asked());

  const auto open = make({.port = 0, .address = "0.0.0.0"});
  EXPECT_THAT(open->url(),
              ::testing::MatchesRegex("http://0\\.0\\.0\\.0:[0-9]+/\\?token=[0-9a-f]{32}"));
  EXPECT_THAT(get(port(*open), "/"), StartsWith("HTTP/1.1 403"));
}

TEST_F(LiveView, HasAsManyViewersAsItMay) {
  const auto narrow = make({.port = 0, .viewers = 1});
  narrow->frame(report_of(0));
  TestViewer first(port(*narrow));
  ASSERT_TRUE(first.asked());
  EXPECT_THROW(TestViewer{port(*narrow)}, boost::system::system_error);
  EXPECT_THAT(get(port(*narrow), "/"), StartsWith("HTTP/1.1 200"));
}

/// Empty where there is none.
fs::path browser() {
  std::istringstream folders(std::getenv("PATH") ? std::getenv("PATH") : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    for (const char* name : {"chromium", "chromium-browser", "google-chrome"})
      if (fs::exists(fs::path(folder) / name)) return fs::path(folder) / name;
  return {};
}

std::string text_of(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST_F(LiveView, IsShownByABrowser) {
  if (page().find("<script>") == std::string_view::npos)
    GTEST_SKIP() << "built without the page: npm or esbuild are missing";
  if (browser().empty()) GTEST_SKIP() << "no chromium in PATH: apt-get install chromium";
  const fs::path folder = fs::path(::testing::TempDir()) / "output_web_browser";
  fs::remove_all(folder);
  fs::create_directories(folder);
  for (std::size_t i = 0; i < recording().size(); ++i) output->frame(report_of(i));
  const std::string command =
      "python3 '" STILLPOINT_SOURCE_DIR "/plugins/output_web/test_browser.py' '" +
      browser().string() + "' '" + output->url() + "' " +
      "\"document.getElementById('legend').children.length > 0\" > '" + (folder / "dom").string() +
      "' 2> '" + (folder / "log").string() + "'";
  ASSERT_EQ(std::system(command.c_str()), 0) << text_of(folder / "log");
  const std::string dom = text_of(folder / "dom");
  for (const char* shown :
       {"<dt>frames</dt><dd>4</dd>", "class=\"badge tracking\"", "1 fit the pose", ">frame 3<",
        "<td>track</td><td class=\"number\">5.0</td>", "data-engine=\"three.js"})
    EXPECT_NE(dom.find(shown), std::string::npos) << shown;
  EXPECT_EQ(text_of(folder / "log"), "");
  fs::remove_all(folder);
}

std::string failure_of(const WebOutput::Options& options) {
  try {
    const WebOutput output(options, testing::test_context());
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kUsage);
    return error.what();
  }
  return "none";
}

TEST_F(LiveView, SaysWhatIsWrongWithItsOptions) {
  EXPECT_EQ(failure_of({.port = port(*output)}),
            "port: port " + std::to_string(port(*output)) +
                " is taken by another program; choose another one; 0 takes any that is free");
  EXPECT_THAT(failure_of({.port = 0, .address = "robot"}), HasSubstr("in numbers"));
  EXPECT_THAT(failure_of({.port = 0, .address = "192.0.2.1"}), HasSubstr("192.0.2.1"));
  EXPECT_THAT(failure_of({.port = 0, .token = "a b"}), HasSubstr("letters"));
}

}  // namespace
}  // namespace stillpoint::output_web
