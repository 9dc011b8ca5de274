#include "propagator_flow_depth/flow_depth_propagator.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <set>

namespace stillpoint {
namespace {

using ::testing::HasSubstr;

constexpr int kPerson = 15;
constexpr int kChair = 9;
const cv::Size kSize(320, 240);

/// A textured rectangle at some depth.
struct Box {
  cv::Rect area;
  float depth;
  int label;
};

cv::Mat texture(cv::Size size, int seed) {
  cv::Mat noise(size.height / 4 + 1, size.width / 4 + 1, CV_8UC1), image;
  cv::RNG(static_cast<std::uint64_t>(seed)).fill(noise, cv::RNG::UNIFORM, 0, 256);
  cv::resize(noise, image, size, 0, 0, cv::INTER_CUBIC);
  return image;
}

/// A wall 4 m away and boxes before it; later boxes lie over earlier ones.
struct Scene {
  Frame frame;
  cv::Mat labels{kSize, CV_8UC1, cv::Scalar(0)};

  Scene(std::uint32_t index, const std::vector<Box>& boxes) {
    frame.index = index;
    frame.time = index / 30.0;
    frame.gray = texture(kSize, 1);
    frame.depth = cv::Mat(kSize, CV_32FC1, cv::Scalar(4));
    Camera camera;
    camera.fx = camera.fy = 260;
    frame.camera = std::make_shared<const Camera>(camera);
    int seed = 2;
    for (const Box& box : boxes) {
      const cv::Rect seen = box.area & cv::Rect({}, kSize);
      const cv::Mat skin = texture(box.area.size(), seed++);
      if (seen.empty()) continue;
      skin(seen - box.area.tl()).copyTo(frame.gray(seen));
      frame.depth(seen).setTo(box.depth);
      labels(seen).setTo(box.label);
    }
  }
  Segmentation truth() const {
    Segmentation result{.labels = labels, .frame = frame.index};
    find_objects(result, 20);
    return result;
  }
  Segmentation nothing() const {
    return {.labels = cv::Mat(kSize, CV_8UC1, cv::Scalar(0)),
            .instances = cv::Mat(kSize, CV_8UC1, cv::Scalar(0)),
            .frame = frame.index};
  }
};

double overlap(const cv::Mat& a, const cv::Mat& b, int label = kPerson) {
  const cv::Mat x = a == label, y = b == label;
  return static_cast<double>(cv::countNonZero(x & y)) / std::max(1, cv::countNonZero(x | y));
}

Box walker(int index, int label = kPerson) { return {{60 + 5 * index, 60, 60, 120}, 2.0f, label}; }

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

/// What a network leaves that has found only the upper `rows` rows.
Segmentation upper_part(const Scene& scene, int rows) {
  Segmentation result{.labels = scene.labels.clone(), .frame = scene.frame.index};
  result.labels.rowRange(rows, kSize.height).setTo(0);
  find_objects(result, 20);
  return result;
}

TEST(FlowDepthPropagator, KeepsThePartThatTheNetworkMisses) {
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

TEST(FlowDepthPropagator, OutlinesThatWobbleAreNoPartsOfTheirOwn) {
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

TEST(FlowDepthPropagator, WhatPassesBeforeAnObjectIsNotPartOfIt) {
  FlowDepthPropagator propagator({});
  const Scene first(0, {walker(0)});
  for (int i = 0; i < 8; ++i) {
    const Scene now(i, {walker(i), {{200 - 15 * i, 90, 50, 60}, 1.2f, 0}});
    const Segmentation carried = propagator.propagate(first.truth(), first.frame, now.frame);
    EXPECT_GT(overlap(carried.labels, now.labels), 0.8) << i;
  }
}

TEST(FlowDepthPropagator, TouchingObjectsStayApart) {
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

TEST(FlowDepthPropagator, ADeskTakenForAPartOfSomebodyDoesNotTakeTheirPlace) {
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

TEST(FlowDepthPropagator, PeopleWithOneMaskStayTwo) {
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

TEST(FlowDepthPropagator, DepthMendsAnImperfectMask) {
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

TEST(FlowDepthPropagator, DoesNotFloodWhatIsTouched) {
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
}  // namespace stillpoint
