// Poses, key frames, maps and corrections as a plugin written carelessly would give them: each is
// refused, with what is wrong and what to do.
#include "stillpoint/runtime/mapping_results.hpp"

#include <gmock/gmock.h>

#include <functional>
#include <opencv2/core.hpp>

#include "wrong_results.hpp"

namespace stillpoint {
namespace {

using ::testing::HasSubstr;

TrackResult right_result(const Frame& frame) {
  TrackResult result{.state = TrackState::kTracking, .reference = 3};
  KeyFrame keyframe{.id = 3, .frame = frame.index, .time = frame.time, .camera = frame.camera};
  keyframe.features = std::make_shared<const Features>(
      Features{.keypoints = {{}, {}}, .descriptors = {{}, {}}, .depth = {1, 1}});
  keyframe.track_weights = keyframe.map_weights = {255, 255};
  keyframe.landmarks = {kNoId, kNoId};
  result.keyframe = keyframe;
  return result;
}

std::function<void(TrackResult&)> with_features(const std::function<void(Features&)>& spoil) {
  return [spoil](TrackResult& result) {
    Features features = *result.keyframe->features;
    spoil(features);
    result.keyframe->features = std::make_shared<const Features>(std::move(features));
  };
}

struct TrackFault {
  const char* name;
  std::function<void(TrackResult&)> spoil;
  const char* message;
};

class WrongTracking : public ::testing::TestWithParam<TrackFault> {};

TEST_P(WrongTracking, IsRefused) {
  const Frame frame = right_frame(7);
  TrackResult result = right_result(frame);
  const auto message = [&] {
    return message_of([&] { check_tracking(result, frame, {}, {.next_keyframe = 3}); });
  };
  ASSERT_EQ(message(), "");
  GetParam().spoil(result);
  EXPECT_THAT(message(), HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    MappingResults, WrongTracking,
    ::testing::Values(
        TrackFault{"NanPose", [](TrackResult& r) { r.world_from_camera.translation().x() = kNan; },
                   "the pose is no rigid motion"},
        TrackFault{"BegunAnew", [](TrackResult& r) { r.begins_anew = true; },
                   "it begins the map anew, but may not"},
        TrackFault{"Scaled", [](TrackResult& r) { r.reference_from_camera.linear() *= 1.1; },
                   "the pose is no rigid motion"},
        TrackFault{"Mirrored", [](TrackResult& r) { r.world_from_camera.linear()(0, 0) = -1; },
                   "the pose is no rigid motion"},
        TrackFault{"NoReference", [](TrackResult& r) { r.reference = kNoId; },
                   "the reference is key frame kNoId of 4"},
        TrackFault{"ReferenceToCome", [](TrackResult& r) { r.reference = 4; },
                   "the reference is key frame 4 of 4"},
        TrackFault{"Id", [](TrackResult& r) { r.keyframe->id = 2; },
                   "the key frame has id 2, but the next one is 3"},
        TrackFault{"Frame", [](TrackResult& r) { r.keyframe->frame = 6; }, "is of frame 6"},
        TrackFault{"Time", [](TrackResult& r) { r.keyframe->time = kNan; },
                   "the time of the key frame is not that of its frame"},
        TrackFault{"Camera", [](TrackResult& r) { r.keyframe->camera = nullptr; },
                   "the key frame has no camera"},
        TrackFault{"Features", [](TrackResult& r) { r.keyframe->features = nullptr; },
                   "the key frame has no features"},
        TrackFault{"Weights", [](TrackResult& r) { r.keyframe->map_weights.pop_back(); },
                   "has 2 keypoints, but 1 map weights; give one of each per keypoint"},
        TrackFault{"MoreWeights", [](TrackResult& r) { r.keyframe->track_weights.push_back(255); },
                   "has 2 keypoints, but 3 track weights; give one of each per keypoint"},
        TrackFault{"Descriptors", with_features([](Features& f) { f.descriptors.pop_back(); }),
                   "has 2 keypoints, but 1 descriptors; give one of each per keypoint"},
        TrackFault{"Depths", with_features([](Features& f) { f.depth.clear(); }),
                   "has 2 keypoints, but 0 depths; give one of each per keypoint"},
        TrackFault{"Landmarks", [](TrackResult& r) { r.keyframe->landmarks.pop_back(); },
                   "has 2 keypoints, but 1 landmarks; give one of each per keypoint"},
        TrackFault{"Landmark", [](TrackResult& r) { r.keyframe->landmarks[0] = 0; },
                   "sees a landmark that is not in the map"},
        TrackFault{"KeyFramePose",
                   [](TrackResult& r) { r.keyframe->world_from_camera.matrix()(0, 0) = kNan; },
                   "the pose of the key frame is no rigid motion"},
        TrackFault{"OtherPose", [](TrackResult& r) { r.world_from_camera.translation().x() = 5; },
                   "the key frame has another pose than its frame"},
        TrackFault{"TwoPoses",
                   [](TrackResult& r) { r.reference_from_camera.translation().x() = 0.01; },
                   "reference_from_camera and world_from_camera are two different poses"},
        TrackFault{"Outside", with_features([](Features& f) { f.keypoints[1].pt.x = 6; }),
                   "wrong features: a keypoint is not in the image"},
        TrackFault{"NanPixel", with_features([](Features& f) { f.keypoints[1].pt.y = kFloatNan; }),
                   "a keypoint is not in the image"},
        TrackFault{"Octave", with_features([](Features& f) { f.keypoints[0].octave = 8; }),
                   "a keypoint has octave 8 of 8"},
        TrackFault{"NegativeOctave", with_features([](Features& f) { f.keypoints[0].octave = -1; }),
                   "a keypoint has octave -1 of 8"},
        TrackFault{"Levels", with_features([](Features& f) { f.levels = 65; }),
                   "no pyramid of 1 to 64 levels"},
        TrackFault{"ScaleFactor", with_features([](Features& f) { f.scale_factor = 0.5; }),
                   "no pyramid of 1 to 64 levels, with a factor of 1 to 4"},
        TrackFault{"Angle", with_features([](Features& f) { f.keypoints[0].angle = kFloatNan; }),
                   "the size, angle or response of a keypoint"},
        TrackFault{"NegativeDepth", with_features([](Features& f) { f.depth[0] = -1; }),
                   "the depth of a feature is negative"},
        TrackFault{"Covariance", [](TrackResult& r) { r.keyframe->covariance(1, 1) = kNan; },
                   "the covariance of the key frame is not finite"},
        TrackFault{"ImpossibleCamera",
                   [](TrackResult& r) {
                     r.keyframe->camera = std::make_shared<const Camera>(
                         Camera{.width = 4, .height = 3, .fx = kNan});
                   },
                   "the camera of the key frame is not that of its frame"},
        TrackFault{"OtherCamera",
                   [](TrackResult& r) {
                     r.keyframe->camera = std::make_shared<const Camera>(
                         Camera{.width = 4, .height = 3, .fx = 100});
                   },
                   "the camera of the key frame is not that of its frame"},
        TrackFault{"EvidenceOfNoLandmark",
                   [](TrackResult& r) { r.keyframe->evidence = {{.landmark = 3}}; },
                   "has evidence of a landmark that is not in the map"},
        TrackFault{"NegativeInliers", [](TrackResult& r) { r.inliers = -1; },
                   "a number of features, matches or inliers is negative"},
        TrackFault{"NanOfTracked", [](TrackResult& r) { r.tracked = {{.pixel = {kFloatNan, 0}}}; },
                   "the pixel of a tracked feature is not finite"},
        TrackFault{"LostKeyFrame", [](TrackResult& r) { r.state = TrackState::kLost; },
                   "it made a key frame, but is LOST"}),
    [](const auto& test) { return test.param.name; });

TEST(MappingResults, ThePoseByAReferenceInTheMapIsThatOfTheResult) {
  MapEdit map{SparseMap()};
  KeyFrame keyframe{.id = 0};
  keyframe.features = std::make_shared<const Features>();
  keyframe.world_from_camera.translation().x() = 2;
  map.add_keyframe(std::move(keyframe));
  TrackResult result{.state = TrackState::kTracking, .reference = 0};
  const auto message = [&](KeyFrameId next) {
    return message_of(
        [&] { check_tracking(result, right_frame(), map.map(), {.next_keyframe = next}); });
  };
  EXPECT_THAT(message(1), HasSubstr("are two different poses; world_from_camera = map."));
  result.world_from_camera.translation().x() = 2;
  EXPECT_EQ(message(1), "");
  result.reference = 1;  // still on its way to local mapping: its pose is not known here
  EXPECT_EQ(message(2), "");
}

TEST(MappingResults, AMapThatStaysAsItIsGetsNoKeyFrame) {
  const Frame frame = right_frame(7);
  TrackResult result = right_result(frame);
  const TrackHints hints{.next_keyframe = 4, .localise_only = true};
  const auto message = [&] {
    return message_of([&] { check_tracking(result, frame, {}, hints); });
  };
  EXPECT_THAT(message(), HasSubstr("it made a key frame, but the map stays as it is"));
  result.keyframe.reset();
  EXPECT_EQ(message(), "");
}

TEST(MappingResults, WhatIsPreparedIsTheFrame) {
  const auto frame = std::make_shared<const Frame>(right_frame());
  const PreparedFrame right(frame), other(std::make_shared<const Frame>(right_frame()));
  const auto message = [&](const PreparedFrame* prepared) {
    return message_of([&] { check_prepared(prepared, *frame); });
  };
  EXPECT_EQ(message(&right), "");
  EXPECT_THAT(message(&other), HasSubstr("prepare() gave another frame"));
  EXPECT_THAT(message(nullptr), HasSubstr("prepare() gave nothing"));
}

SparseMap map_with_keyframes(KeyFrameId count) {
  MapEdit map{SparseMap()};
  for (KeyFrameId id = 0; id < count; ++id) {
    KeyFrame keyframe{.id = id, .camera = std::make_shared<const Camera>()};
    keyframe.features = std::make_shared<const Features>();
    map.add_keyframe(std::move(keyframe));
  }
  return map.map();
}

TEST(MappingResults, AMapThatIsNoNextVersionIsRefused) {
  const SparseMap before = map_with_keyframes(2), after = map_with_keyframes(3);
  EXPECT_EQ(message_of([&] { check_inserted(after, before); }), "");
  EXPECT_EQ(message_of([&] { check_refined(after, after); }), "");
  EXPECT_THAT(message_of([&] { check_inserted(before, before); }),
              HasSubstr("key frame 2 was not added to the map"));
  EXPECT_THAT(message_of([&] { check_refined(before, after); }),
              HasSubstr("ids of the map are gone"));
  EXPECT_THAT(message_of([&] { check_inserted({}, before); }), HasSubstr("key frame 2"));
}

/// Of a change to a map of three key frames, the last of which sees landmark 0.
std::string message_of_change(const std::function<void(MapEdit&)>& spoil) {
  MapEdit before(map_with_keyframes(2));
  KeyFrame seeing{.id = 2, .camera = std::make_shared<const Camera>()};
  seeing.features = std::make_shared<const Features>(
      Features{.keypoints = {{}}, .descriptors = {{}}, .depth = {1}});
  seeing.track_weights = seeing.map_weights = {255};
  seeing.landmarks = {kNoId};
  before.add_keyframe(std::move(seeing));
  before.add_observation(before.add_landmark({.reference = 2}), {.keyframe = 2, .feature = 0});
  MapEdit after(before.map());
  spoil(after);
  return message_of([&] { check_refined(after.map(), before.map()); });
}

// What a stage that reads the map would crash on.
TEST(MappingResults, KeyFramesInTheMapKeepTheirParts) {
  const auto message = message_of_change;
  EXPECT_EQ(message([](MapEdit& map) { map.keyframe(2).time = 1; }), "");
  EXPECT_THAT(message([](MapEdit& map) { map.keyframe(2).features = nullptr; }),
              HasSubstr("key frame 2 has no features"));
  EXPECT_THAT(message([](MapEdit& map) { map.keyframe(1).camera = nullptr; }),
              HasSubstr("key frame 1 has no camera"));
  EXPECT_THAT(message([](MapEdit& map) { map.keyframe(2).landmarks.clear(); }),
              HasSubstr("key frame 2 has 1 keypoints, but 0 landmarks"));
  EXPECT_THAT(message([](MapEdit& map) { map.keyframe(2).landmarks[0] = 1; }),
              HasSubstr("key frame 2 sees a landmark that is not in the map"));
  EXPECT_THAT(message([](MapEdit& map) { map.landmark(0).observations[0].feature = 1; }),
              HasSubstr("landmark 0 is seen as a feature that is not in the map"));
  EXPECT_THAT(message([](MapEdit& map) { map.landmark(0).observations[0].keyframe = 7; }),
              HasSubstr("landmark 0 is seen as a feature that is not in the map"));
}

TEST(MappingResults, EvidenceOfLandmarksIsFinite) {
  const Frame frame = right_frame(7);
  MapEdit map(map_with_keyframes(3));
  map.add_landmark({});
  TrackResult result = right_result(frame);
  result.keyframe->evidence = {{.landmark = 0, .static_log_odds = 1}};
  const auto message = [&] {
    return message_of([&] { check_tracking(result, frame, map.map(), {.next_keyframe = 3}); });
  };
  EXPECT_EQ(message(), "");
  result.keyframe->evidence[0].static_log_odds = kFloatNan;
  EXPECT_THAT(message(), HasSubstr("the evidence of a landmark is not finite"));
}

TEST(MappingResults, WhatIsNewInAMapIsFinite) {
  const auto message = message_of_change;
  EXPECT_EQ(message([](MapEdit&) {}), "");
  EXPECT_THAT(message([](MapEdit& map) { map.keyframe(1).world_from_camera(0, 3) = kNan; }),
              HasSubstr("the pose of key frame 1 is no rigid motion"));
  EXPECT_THAT(message([](MapEdit& map) { map.keyframe(2).world_from_camera.linear() *= 2; }),
              HasSubstr("the pose of key frame 2 is no rigid motion"));
  EXPECT_THAT(message([](MapEdit& map) { map.landmark(0).position_in_world.z() = kNan; }),
              HasSubstr("landmark 0 is wrong: its position is not finite, or beyond 10,000 km; "));
  EXPECT_THAT(message([](MapEdit& map) { map.landmark(0).max_distance = INFINITY; }),
              HasSubstr("landmark 0 is wrong: its distances"));
  EXPECT_THAT(message([](MapEdit& map) { map.landmark(0).static_log_odds = NAN; }),
              HasSubstr("landmark 0 is wrong: its log-odds are not finite"));
  EXPECT_THAT(message([](MapEdit& map) { map.landmark(0).mean_view *= 2; }),
              HasSubstr("landmark 0 is wrong: its mean view is no unit vector"));
  EXPECT_THAT(message([](MapEdit& map) { map.keyframe(1).world_from_camera(0, 3) = 1e8; }),
              HasSubstr("the pose of key frame 1 is no rigid motion"));
}

TEST(MappingResults, WrongCorrectionsAreRefused) {
  const SparseMap map = map_with_keyframes(2);
  const auto message = [&](const MapCorrection& correction) {
    return message_of([&] { check_correction(correction, map); });
  };
  EXPECT_EQ(message({.keyframe_id_end = 2, .moved = {{1, Pose::Identity()}}}), "");
  EXPECT_THAT(message({.keyframe_id_end = 3}), HasSubstr("of a map with more key frames"));
  EXPECT_THAT(message({.moved = {{2, Pose::Identity()}}}), HasSubstr("names key frame 2 of 2"));
  EXPECT_THAT(message({.moved = {{1, Pose::Identity()}}}),
              HasSubstr("of a map with 0 key frames, but moves key frame 1"));
  EXPECT_THAT(message({.keyframe_id_end = 2, .moved = {{1, Pose(Eigen::Scaling(2.0))}}}),
              HasSubstr("the new pose of key frame 1 is no rigid motion"));
  EXPECT_THAT(message({.landmarks = {{0, Eigen::Vector3d::Zero()}}}),
              HasSubstr("names landmark 0 of 0"));
  EXPECT_THAT(message({.fused = {{0, kNoId}}}), HasSubstr("names landmark 0 of 0"));
}

TEST(MappingResults, NewPositionsOfLandmarksAreFinite) {
  MapEdit edit(map_with_keyframes(1));
  KeyFrame seeing{.id = 1};
  seeing.features = std::make_shared<const Features>(
      Features{.keypoints = {{}}, .descriptors = {{}}, .depth = {1}});
  seeing.landmarks = {kNoId};
  edit.add_keyframe(std::move(seeing));
  edit.add_observation(edit.add_landmark({.reference = 1}), {.keyframe = 1, .feature = 0});
  const SparseMap map = edit.map();
  const auto message = [&](const Eigen::Vector3d& position) {
    return message_of([&] {
      check_correction({.keyframe_id_end = 2, .landmarks = {{0, position}}}, map);
    });
  };
  EXPECT_EQ(message({1, 2, 3}), "");
  for (const double wrong : {kNan, 1e300, -1e8})
    EXPECT_THAT(message({0, wrong, 0}), HasSubstr("the new position of landmark 0 is not finite, "
                                                  "or beyond 10,000 km; leave out"));
}

TEST(MappingResults, WrongPointsOfADenseMapAreRefused) {
  const auto message = [](const LabelledPoint& point) {
    return message_of([&] { check_points({&point, 1}); });
  };
  EXPECT_EQ(message({}), "");
  EXPECT_THAT(message({.position = {0, kFloatNan, 0}}),
              HasSubstr("of the dense map is not finite"));
  EXPECT_THAT(message({.occupancy = 1.5F}), HasSubstr("with a probability of 1.5"));
  EXPECT_THAT(message({.occupancy = kFloatNan}), HasSubstr("with a probability of nan"));
}

TEST(MappingResults, WhoIsLostNeedsNoPose) {
  TrackResult result{.state = TrackState::kLost};
  result.world_from_camera.translation().x() = kNan;
  EXPECT_EQ(message_of([&] { check_tracking(result, right_frame(), {}, {}); }), "");
}

}  // namespace
}  // namespace stillpoint
