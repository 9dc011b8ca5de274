// Carrying objects from frame to frame, and letting them go.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "propagator_flow_depth/flow_depth_propagator.hpp"
#include "propagator_flow_depth/test_scene.hpp"

namespace stillpoint::propagator_flow_depth {
namespace {

TEST(FlowDepthPropagator, CarriesLabelsOfAnOlderFrame) {
  FlowDepthPropagator propagator({});
  const Scene first(0, {walker(0)});
  int id = -1;
  for (std::uint32_t i = 0; i < 8; ++i) {
    const Scene now(i, {walker(static_cast<int>(i))});
    const Segmentation carried = propagator.propagate(first.truth(), first.frame, now.frame);
    EXPECT_EQ(carried.frame, i);
    ASSERT_EQ(carried.objects.size(), 1U);
    EXPECT_GT(overlap(carried.labels, now.labels), 0.9) << i;
    if (id < 0) id = carried.objects[0].id;
    EXPECT_EQ(carried.objects[0].id, id);
    EXPECT_EQ(carried.objects[0].pixels, cv::countNonZero(carried.labels));
    EXPECT_EQ(carried.objects[0].box, cv::boundingRect(carried.labels));
  }
}

TEST(FlowDepthPropagator, AResultThatComesLateIsBroughtForward) {
  FlowDepthPropagator propagator({});
  std::vector<Scene> scenes;
  for (int i = 0; i < 8; ++i) scenes.emplace_back(i, std::vector<Box>{walker(i)});
  for (std::size_t i = 0; i < 7; ++i)
    propagator.propagate(scenes[0].nothing(), scenes[0].frame, scenes[i].frame);
  const Segmentation carried =
      propagator.propagate(scenes[2].truth(), scenes[2].frame, scenes[7].frame);
  EXPECT_GT(overlap(carried.labels, scenes[7].labels), 0.9);
}

TEST(FlowDepthPropagator, IdsStayOverResults) {
  FlowDepthPropagator propagator({});
  std::vector<int> ids;
  for (int i = 0; i < 10; ++i) {
    const Scene now(i, {{{200, 100, 60, 60}, 3.0f, kChair}, walker(i)});
    const Segmentation carried = propagator.propagate(now.truth(), now.frame, now.frame);
    ASSERT_EQ(carried.objects.size(), 2U);
    for (const SegmentedObject& object : carried.objects)
      if (object.label == kPerson) ids.push_back(object.id);
  }
  EXPECT_THAT(ids, testing::Each(ids[0]));
}

TEST(FlowDepthPropagator, IdsStayWithASlowNetwork) {
  constexpr int kLatency = 20;  // frames: more than there are views of
  FlowDepthPropagator propagator({.keep_seconds = 10});
  const Box chair{{200, 100, 60, 60}, 3.0f, kChair};
  std::vector<int> ids;
  for (int i = 0; i < 4 * kLatency; ++i) {
    const Scene now(i, {chair}), before(i < kLatency ? 0 : (i / kLatency - 1) * kLatency, {chair});
    const Segmentation carried = propagator.propagate(before.truth(), before.frame, now.frame);
    ASSERT_EQ(carried.objects.size(), 1U) << i;
    ids.push_back(carried.objects[0].id);
  }
  EXPECT_THAT(ids, testing::Each(ids[0]));
}

TEST(FlowDepthPropagator, KeepsWhatTheNetworkMisses) {
  FlowDepthPropagator propagator({.max_misses = 5});
  for (int i = 0; i < 20; ++i) {
    const Scene now(i, {walker(i)});
    const Segmentation found = i < 8 ? now.truth() : now.nothing();
    const Segmentation carried = propagator.propagate(found, now.frame, now.frame);
    EXPECT_EQ(carried.objects.size(), i < 13 ? 1U : 0U) << i;
    EXPECT_GE(overlap(carried.labels, now.labels), i < 13 ? 0.85 : 0.0) << i;
  }
}

TEST(FlowDepthPropagator, KeepsNothingLongerThanAsked) {
  FlowDepthPropagator propagator({.keep_seconds = 0.11, .max_misses = 100});
  for (int i = 0; i < 20; ++i) {
    const Scene now(i, {walker(i)});
    const Segmentation carried =
        propagator.propagate(i < 10 ? now.truth() : now.nothing(), now.frame, now.frame);
    EXPECT_EQ(carried.objects.size(), i < 13 ? 1U : 0U) << i;
  }
}

TEST(FlowDepthPropagator, WhatWasSeenOnceIsNotKeptLong) {
  FlowDepthPropagator propagator({});
  for (int i = 0; i < 4; ++i) {
    const Scene now(i, {walker(0)});
    const Segmentation carried =
        propagator.propagate(i == 0 ? now.truth() : now.nothing(), now.frame, now.frame);
    EXPECT_EQ(carried.objects.size(), i < 2 ? 1U : 0U) << i;
  }
}

TEST(FlowDepthPropagator, LetsGoWhatLeaves) {
  FlowDepthPropagator propagator({.keep_seconds = 60, .max_misses = 100});
  for (int i = 0; i < 30; ++i) {
    const Scene now(i, {{{200 + 8 * i, 60, 60, 120}, 2.0f, kPerson}});
    const Segmentation carried =
        propagator.propagate(i < 8 ? now.truth() : now.nothing(), now.frame, now.frame);
    EXPECT_TRUE(i < 18 || carried.objects.empty()) << i;
  }
}

TEST(FlowDepthPropagator, LetsGoWhoseDepthIsGone) {
  FlowDepthPropagator propagator({.keep_seconds = 60, .max_misses = 100});
  for (int i = 0; i < 12; ++i) {
    const Scene now(i, i < 8 ? std::vector<Box>{walker(0)} : std::vector<Box>{});
    const Segmentation carried =
        propagator.propagate(i < 8 ? now.truth() : now.nothing(), now.frame, now.frame);
    EXPECT_TRUE(i < 9 || carried.objects.empty()) << i;
  }
}

TEST(FlowDepthPropagator, LetsGoWhoseDepthIsGoneAlsoWithASlowNetwork) {
  FlowDepthPropagator propagator({.keep_seconds = 0.5});
  const Box chair{{200, 100, 60, 60}, 3.0f, kChair};
  const Scene first(0, {chair, walker(0)});
  for (int i = 0; i < 40; ++i) {
    const Scene now(i, i < 8 ? std::vector<Box>{chair, walker(0)} : std::vector<Box>{chair});
    const Segmentation carried = propagator.propagate(first.truth(), first.frame, now.frame);
    if (i < 16) continue;
    ASSERT_EQ(carried.objects.size(), 1U) << i;
    EXPECT_EQ(carried.objects[0].label, kChair);
  }
}

TEST(FlowDepthPropagator, UnknownIsNotNothing) {
  FlowDepthPropagator propagator({});
  const Scene now(0, {walker(0)});
  EXPECT_FALSE(propagator.propagate({}, now.frame, now.frame).known());
}

TEST(FlowDepthPropagator, BlackImagesAndNoDepthDoNoHarm) {
  for (const bool with_depth : {true, false}) {
    FlowDepthPropagator propagator({});
    for (std::uint32_t i = 0; i < 5; ++i) {
      Scene now(i, {walker(0)});
      now.frame.gray.setTo(0);
      if (!with_depth) now.frame.depth.setTo(0);
      const Segmentation carried = propagator.propagate(now.truth(), now.frame, now.frame);
      EXPECT_GT(overlap(carried.labels, now.labels), 0.9);
    }
    Scene now(5, {walker(0)});
    now.frame.depth.release();
    EXPECT_TRUE(propagator.propagate(now.truth(), now.frame, now.frame).known());
  }
}

TEST(FlowDepthPropagator, ANewImageSizeBeginsAnew) {
  FlowDepthPropagator propagator({});
  const Scene now(0, {walker(0)});
  propagator.propagate(now.truth(), now.frame, now.frame);
  Frame small;
  small.index = 1;
  small.gray = cv::Mat(99, 131, CV_8UC1, cv::Scalar(0));
  Segmentation labels{.labels = cv::Mat(99, 131, CV_8UC1, cv::Scalar(0)), .frame = 1};
  EXPECT_EQ(propagator.propagate(labels, small, small).labels.size(), small.gray.size());
}

TEST(FlowDepthPropagator, IsReproducible) {
  FlowDepthPropagator a({}), b({});
  const Scene first(0, {{{200, 100, 60, 60}, 3.0f, kChair}, walker(0)});
  for (int i = 0; i < 6; ++i) {
    const Scene now(i, {{{200, 100, 60, 60}, 3.0f, kChair}, walker(i)});
    const Segmentation x = a.propagate(first.truth(), first.frame, now.frame);
    const Segmentation y = b.propagate(first.truth(), first.frame, now.frame);
    EXPECT_EQ(cv::norm(x.labels, y.labels, cv::NORM_INF), 0);
    EXPECT_EQ(cv::norm(x.instances, y.instances, cv::NORM_INF), 0);
  }
}

}  // namespace
}  // namespace stillpoint::propagator_flow_depth
