#include "stillpoint/runtime/map_values.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <memory>

#include "stillpoint/runtime/map_reader.hpp"

namespace stillpoint {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

KeyFrame good_keyframe(const std::function<void(Features&)>& spoil = [](Features&) {}) {
  auto features = std::make_shared<Features>();
  features->keypoints = {{100.0F, 50.0F, 31.0F, 90.0F, 40.0F, 7}, {0.0F, 479.0F, 31.0F}};
  features->keypoints[1].octave = 0;
  features->descriptors.resize(2);
  features->depth = {0.0F, 2.5F};
  spoil(*features);
  KeyFrame keyframe;
  keyframe.time = 1.5;
  keyframe.camera = std::make_shared<const Camera>();
  keyframe.features = features;
  return keyframe;
}

TEST(MapValues, WhatCanBeIsAccepted) {
  EXPECT_NO_THROW(check_values(Camera{}));
  EXPECT_NO_THROW(check_values(Landmark{}));
  EXPECT_NO_THROW(check_values(good_keyframe()));
}

TEST(MapValues, OfCameras) {
  const auto refused = [](auto Camera::*member, auto value) {
    Camera camera;
    camera.*member = value;
    EXPECT_THROW(check_values(camera), DamagedMap) << value;
  };
  refused(&Camera::width, 0);
  refused(&Camera::height, 2'000'000'000);
  refused(&Camera::fx, 1e308);
  refused(&Camera::fy, 0.0);
  refused(&Camera::cx, kNaN);
  refused(&Camera::cy, kInfinity);
  refused(&Camera::depth_noise, 0.0);
  refused(&Camera::depth_noise, 1e300);
  refused(&Camera::surface_noise, -1.0);
  refused(&Camera::surface_noise, kNaN);
}

TEST(MapValues, OfLandmarks) {
  const auto refused = [](const std::function<void(Landmark&)>& spoil) {
    Landmark landmark;
    spoil(landmark);
    EXPECT_THROW(check_values(landmark), DamagedMap);
  };
  refused([](Landmark& l) { l.position_in_world.x() = kNaN; });
  refused([](Landmark& l) { l.position_in_world.y() = 1e300; });
  refused([](Landmark& l) { l.mean_view = {0, 0, 1e9}; });
  refused([](Landmark& l) { l.min_distance = -1; });
  refused([](Landmark& l) { l.min_distance = l.max_distance + 1; });
  refused([](Landmark& l) { l.static_log_odds = static_cast<float>(kInfinity); });
}

TEST(MapValues, OfFeatures) {
  const auto refused = [](const std::function<void(Features&)>& spoil) {
    EXPECT_THROW(check_values(good_keyframe(spoil)), DamagedMap);
  };
  refused([](Features& f) { f.keypoints[0].octave = std::numeric_limits<int>::max(); });
  refused([](Features& f) { f.keypoints[0].octave = std::numeric_limits<int>::min(); });
  refused([](Features& f) { f.keypoints[0].octave = f.levels; });
  refused([](Features& f) { f.keypoints[0].pt.x = 1e9F; });
  refused([](Features& f) { f.keypoints[0].pt.y = static_cast<float>(kNaN); });
  refused([](Features& f) { f.depth[0] = -1; });
  refused([](Features& f) { f.scale_factor = 1e300; });
  refused([](Features& f) { f.levels = 2'000'000'000; });
}

TEST(MapValues, OfPosesAndTimes) {
  const auto refused = [](const std::function<void(KeyFrame&)>& spoil) {
    KeyFrame keyframe = good_keyframe();
    spoil(keyframe);
    EXPECT_THROW(check_values(keyframe), DamagedMap);
  };
  refused([](KeyFrame& k) { k.time = kInfinity; });
  refused([](KeyFrame& k) { k.world_from_camera(0, 3) = kNaN; });
  refused([](KeyFrame& k) { k.world_from_camera(1, 3) = 1e300; });
  refused([](KeyFrame& k) { k.world_from_camera(0, 0) = 2; });
  refused([](KeyFrame& k) { k.world_from_camera.linear() *= -1; });
  refused([](KeyFrame& k) { k.world_from_camera(3, 3) = 0; });
}

}  // namespace
}  // namespace stillpoint
