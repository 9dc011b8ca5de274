// Masks that are wrong, touch or hide each other.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <set>

#include "propagator_flow_depth/flow_depth_propagator.hpp"
#include "propagator_flow_depth/test_scene.hpp"
#include "stillpoint/support/objects.hpp"

namespace stillpoint::propagator_flow_depth {
namespace {

/// What a network leaves that has found only the upper `rows` rows.
Segmentation upper_part(const Scene& scene, int rows) {
  Segmentation result{.labels = scene.labels.clone(), .frame = scene.frame.index};
  result.labels.rowRange(rows, kSize.height).setTo(0);
  find_objects(result, 20);
  return result;
}

TEST(ImperfectMask, KeepsThePartThatTheNetworkMisses) {
  FlowDepthPropagator propagator({.max_misses = 5});
  for (int i = 0; i < 20; ++i) {
    const Scene now(i, {walker(i)});
    const Segmentation found = i < 8 ? now.truth() : upper_part(now, 100);
    const Segmentation carried = propagator.propagate(found, now.frame, now.frame);
    if (i < 13) {
      EXPECT_GE(overlap(carried.labels, now.labels), 0.85) << i;
    } else {
      EXPECT_GE(overlap(carried.labels, found.labels), 0.75) << i;  // grown by the margin
    }
  }
}

TEST(ImperfectMask, OutlinesThatWobbleAreNoPartsOfTheirOwn) {
  FlowDepthPropagator propagator({});
  for (int i = 0; i < 12; ++i) {
    const Scene now(i, {walker(i)});
    Segmentation found{.labels = now.labels.clone(), .frame = now.frame.index};
    if (i % 2)
      cv::erode(found.labels, found.labels, cv::Mat(), {-1, -1}, 3);
    else
      cv::dilate(found.labels, found.labels, cv::Mat(), {-1, -1}, 3);
    find_objects(found, 20);
    EXPECT_EQ(propagator.propagate(found, now.frame, now.frame).objects.size(), 1U) << i;
  }
}

TEST(ImperfectMask, WhatPassesBeforeAnObjectIsNotPartOfIt) {
  FlowDepthPropagator propagator({});
  const Scene first(0, {walker(0)});
  for (int i = 0; i < 8; ++i) {
    const Scene now(i, {walker(i), {{200 - 15 * i, 90, 50, 60}, 1.2f, 0}});
    const Segmentation carried = propagator.propagate(first.truth(), first.frame, now.frame);
    EXPECT_GT(overlap(carried.labels, now.labels), 0.8) << i;
  }
}

TEST(ImperfectMask, TouchingObjectsStayApart) {
  FlowDepthPropagator propagator({});
  const auto boxes = [](int i) {
    return std::vector<Box>{{{100, 80, 80, 100}, 2.6f, kChair}, walker(i)};
  };
  const Scene first(0, boxes(0));
  for (int i = 0; i < 6; ++i) {
    const Scene now(i, boxes(i));
    const Segmentation carried = propagator.propagate(first.truth(), first.frame, now.frame);
    EXPECT_GT(overlap(carried.labels, now.labels, kPerson), 0.9) << i;
    EXPECT_GT(overlap(carried.labels, now.labels, kChair), 0.75) << i;
  }
}

TEST(ImperfectMask, ADeskTakenForAPartOfSomebodyDoesNotTakeTheirPlace) {
  FlowDepthPropagator propagator({});
  const Box desk{{0, 150, 320, 90}, 2.8f, 0};  // larger than the person
  int id = -1;
  for (int i = 0; i < 10; ++i) {
    const Scene now(i, {desk, walker(i)});
    Segmentation found = now.truth();
    if (i >= 3) {
      found = {.labels = now.labels.clone(), .frame = now.frame.index};
      found.labels(desk.area).setTo(kPerson);
    }
    const Segmentation carried = propagator.propagate(found, now.frame, now.frame);
    const int instance = carried.instances.at<std::uint8_t>(100, 90 + 5 * i);
    ASSERT_GT(instance, 0) << i;
    if (id < 0) id = carried.objects[0].id;
    EXPECT_EQ(carried.objects[static_cast<std::size_t>(instance) - 1].id, id) << i;
    EXPECT_GT(overlap(carried.instances, now.labels / kPerson * instance, instance), 0.9) << i;
  }
}

TEST(ImperfectMask, PeopleWithOneMaskStayTwo) {
  FlowDepthPropagator propagator({});
  const auto people = [](int i) {
    return std::vector<Box>{{{200 - 5 * i, 40, 90, 160}, 2.6f, kPerson}, walker(i)};
  };
  std::set<int> ids;
  for (int i = 0; i < 10; ++i) {  // meanwhile, most of the one behind can be seen
    const Scene now(i, people(i));
    const Segmentation carried = propagator.propagate(now.truth(), now.frame, now.frame);
    EXPECT_EQ(carried.objects.size(), 2U) << i;
    for (const SegmentedObject& object : carried.objects) ids.insert(object.id);
    EXPECT_GT(overlap(carried.labels, now.labels), 0.9) << i;
  }
  EXPECT_EQ(ids.size(), 2U);
}

TEST(ImperfectMask, DepthMendsAnImperfectMask) {
  FlowDepthPropagator propagator({});
  const Scene now(0, {walker(0)});
  Segmentation found{.labels = now.labels.clone()};
  found.labels(cv::Rect(80, 90, 10, 10)).setTo(0);          // a hole
  found.labels(cv::Rect(60, 60, 6, 120)).setTo(0);          // an edge that is missing
  found.labels(cv::Rect(120, 60, 30, 120)).setTo(kPerson);  // wall taken for a person
  find_objects(found, 20);
  const double before = overlap(found.labels, now.labels);
  const Segmentation carried = propagator.propagate(found, now.frame, now.frame);
  EXPECT_LT(before, 0.65);
  EXPECT_GT(overlap(carried.labels, now.labels), 0.95);
}

TEST(ImperfectMask, DoesNotFloodWhatIsTouched) {
  FlowDepthPropagator propagator({});
  const Scene now(0, {{{0, 120, 320, 60}, 2.0f, 0}, walker(0)});  // a desk as far away
  for (std::uint32_t i = 0; i < 10; ++i) {
    Frame frame = now.frame;
    frame.index = i;
    frame.time = i / 30.0;
    const Segmentation carried = propagator.propagate(now.truth(), now.frame, frame);
    EXPECT_GT(overlap(carried.labels, now.labels), 0.85);
  }
}

}  // namespace
}  // namespace stillpoint::propagator_flow_depth
