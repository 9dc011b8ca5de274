#include "orb_slam/orb_extractor.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <set>

#include "stillpoint/error.hpp"

namespace stillpoint::orb_slam {
namespace {

constexpr int kWidth = 640, kHeight = 480;

// Boxes and discs of all sizes, one on top of the other, with a little noise.
cv::Mat textured_image(int width = kWidth, int height = kHeight) {
  cv::RNG random(5);
  cv::Mat image(height, width, CV_8UC1, cv::Scalar(128));
  for (int i = 0; i < 700; ++i) {
    const cv::Point2f centre(random.uniform(0.F, 1.F * width), random.uniform(0.F, 1.F * height));
    const cv::Size2f size(random.uniform(6.F, 70.F), random.uniform(6.F, 70.F));
    const cv::RotatedRect box(centre, size, random.uniform(0.F, 180.F));
    const cv::Scalar grey(random.uniform(20, 236));
    cv::Point2f corners[4];
    box.points(corners);
    const std::vector<cv::Point> polygon(corners, corners + 4);
    if (i % 3 == 0)
      cv::ellipse(image, box, grey, cv::FILLED, cv::LINE_AA);
    else
      cv::fillConvexPoly(image, polygon, grey, cv::LINE_AA);
  }
  cv::GaussianBlur(image, image, {}, 0.8);
  return image;
}

cv::Mat noisy(const cv::Mat& image, double sigma, int seed) {
  cv::Mat noise(image.size(), CV_16S), result;
  cv::RNG random(static_cast<std::uint64_t>(seed));
  random.fill(noise, cv::RNG::NORMAL, 0, sigma);
  cv::add(image, noise, result, cv::noArray(), CV_8U);
  return result;
}

Features with_descriptors(Features features, const cv::Mat& rows) {
  features.descriptors.resize(features.keypoints.size());
  for (int i = 0; i < rows.rows; ++i)
    std::memcpy(&features.descriptors[static_cast<std::size_t>(i)], rows.ptr(i), 32);
  return features;
}

Features opencv_features(const cv::Mat& gray) {
  Features features;
  cv::Mat descriptors;
  cv::ORB::create(1000)->detectAndCompute(gray, cv::noArray(), features.keypoints, descriptors);
  return with_descriptors(features, descriptors);
}

// OpenCV's descriptors of keypoints that are given with level and angle.
Features described_by_opencv(const cv::Mat& gray, const Features& given) {
  Features features;
  features.keypoints = given.keypoints;
  cv::Mat descriptors;
  cv::ORB::create(1000, 1.2F, 8, 19)->compute(gray, features.keypoints, descriptors);
  return with_descriptors(features, descriptors);
}

std::pair<int, int> cell_of(const cv::KeyPoint& k) {
  return {static_cast<int>(k.pt.x) / 40, static_cast<int>(k.pt.y) / 40};
}

int nearest(const Descriptor& descriptor, const std::vector<Descriptor>& others) {
  int best = -1, best_distance = 65;
  for (std::size_t i = 0; i < others.size(); ++i) {
    const int distance = hamming_distance(descriptor, others[i]);
    if (distance < best_distance) best = static_cast<int>(i), best_distance = distance;
  }
  return best;
}

struct MatchQuality {
  int matches = 0, correct = 0, cells = 0;  // correct: within 3 px, measured on the keypoint's
                                            // level; cells of 40 px that hold one
  double median_error = 0;                  // px, of the correct ones
  double median_turn_error = 0;             // degrees
};

// Mutual nearest neighbours against the known affine motion of the second image.
MatchQuality compare(const Features& a, const Features& b, const cv::Mat& motion) {
  const cv::Matx23d m = motion;
  const double turn = std::atan2(m(1, 0), m(0, 0)) * 180 / CV_PI;
  MatchQuality quality;
  std::vector<double> errors, turn_errors;
  std::set<std::pair<int, int>> cells;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const int j = nearest(a.descriptors[i], b.descriptors);
    if (j < 0 || nearest(b.descriptors[static_cast<std::size_t>(j)], a.descriptors) != int(i))
      continue;
    ++quality.matches;
    const cv::KeyPoint &from = a.keypoints[i], &to = b.keypoints[static_cast<std::size_t>(j)];
    const cv::Vec2d moved = m * cv::Vec3d(from.pt.x, from.pt.y, 1);
    const double error = std::hypot(moved[0] - to.pt.x, moved[1] - to.pt.y);
    if (error > 3 * std::pow(1.2, to.octave)) continue;
    ++quality.correct;
    cells.insert(cell_of(from));
    errors.push_back(error);
    turn_errors.push_back(std::abs(std::remainder(to.angle - from.angle - turn, 360)));
  }
  const auto median = [](std::vector<double>& v) {
    std::sort(v.begin(), v.end());
    return v.empty() ? 1e9 : v[v.size() / 2];
  };
  quality.cells = static_cast<int>(cells.size());
  quality.median_error = median(errors);
  quality.median_turn_error = median(turn_errors);
  return quality;
}

struct Motion {
  double degrees, scale, noise;
};
std::ostream& operator<<(std::ostream& out, const Motion& m) {
  return out << m.degrees << " degrees, scale " << m.scale << ", noise " << m.noise;
}
class OrbExtractorUnder : public testing::TestWithParam<Motion> {};

TEST_P(OrbExtractorUnder, MatchesAtLeastAsWellAsOpenCv) {
  const Motion& p = GetParam();
  const cv::Mat image = textured_image();
  const cv::Mat motion = cv::getRotationMatrix2D({kWidth / 2.F, kHeight / 2.F}, p.degrees, p.scale);
  cv::Mat moved;
  cv::warpAffine(image, moved, motion, image.size(), cv::INTER_AREA, cv::BORDER_REFLECT);
  const cv::Mat first = noisy(image, p.noise, 1), second = noisy(moved, p.noise, 2);

  OrbExtractor extractor(OrbOptions{});
  const Features a = extractor.extract(first), b = extractor.extract(second);
  const MatchQuality ours = compare(a, b, motion);
  const MatchQuality reference = compare(opencv_features(first), opencv_features(second), motion);
  const MatchQuality described =
      compare(described_by_opencv(first, a), described_by_opencv(second, b), motion);
  EXPECT_GT(ours.correct, 150);
  // At the same corners.
  EXPECT_GE(ours.correct, 0.97 * described.correct);
  // At the corners that either would take: OpenCV crowds them at the strongest edges.
  EXPECT_GE(ours.cells, reference.cells);
  EXPECT_LT(ours.median_error, reference.median_error);
  EXPECT_LT(ours.median_turn_error, 5);
}

INSTANTIATE_TEST_SUITE_P(Motions, OrbExtractorUnder,
                         testing::Values(Motion{10, 1, 3}, Motion{45, 1, 3}, Motion{90, 1, 0},
                                         Motion{137, 1, 3}, Motion{180, 1, 6}, Motion{0, 0.83, 3},
                                         Motion{0, 0.6, 3}, Motion{-25, 0.75, 3},
                                         Motion{30, 1.3, 3}));

TEST(OrbExtractor, GivesTheSameForTheSameImage) {
  const cv::Mat image = textured_image();
  OrbExtractor first(OrbOptions{}), second(OrbOptions{});
  second.extract(textured_image(333, 222));  // leaves other sizes in the buffers
  const Features a = first.extract(image), again = first.extract(image), b = second.extract(image);
  ASSERT_EQ(a.size(), 1000U);
  EXPECT_TRUE(a.depth.empty());
  for (const Features* other : {&again, &b}) {
    EXPECT_EQ(a.descriptors, other->descriptors);
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_EQ(a.keypoints[i].pt, other->keypoints[i].pt);
      EXPECT_EQ(a.keypoints[i].angle, other->keypoints[i].angle);
    }
  }
}

TEST(OrbExtractor, LeavesTheImageAsItIs) {
  const cv::Mat image = textured_image(), before = image.clone();
  OrbExtractor extractor(OrbOptions{});
  extractor.extract(image);
  extractor.extract(textured_image(320, 240));
  EXPECT_EQ(cv::norm(image, before, cv::NORM_INF), 0);
}

TEST(OrbExtractor, SharesFeaturesOutToLevels) {
  OrbExtractor extractor(OrbOptions{});
  EXPECT_THAT(extractor.features_per_level(),
              testing::ElementsAre(217, 181, 151, 126, 104, 88, 72, 61));
}

// Strong texture in a quarter of the image, faint texture elsewhere.
TEST(OrbExtractor, CoversFaintRegions) {
  cv::Mat image = textured_image(), faint;
  image.convertTo(faint, CV_8U, 0.25, 90);
  const cv::Rect strong(0, 0, kWidth / 2, kHeight / 2);
  image(strong).copyTo(faint(strong));
  OrbExtractor extractor(OrbOptions{});
  const auto cells_of = [](const Features& features) {
    std::set<std::pair<int, int>> cells;
    for (const cv::KeyPoint& k : features.keypoints) cells.insert(cell_of(k));
    return cells.size();
  };
  OrbExtractor most_even({.oversampling = 1});
  // Of 192 cells; the strong quarter has 48.
  EXPECT_GE(cells_of(most_even.extract(faint)), 155U);
  EXPECT_GE(cells_of(extractor.extract(faint)), 120U);
  EXPECT_LT(cells_of(opencv_features(faint)), 80U);
}

int inside(const Features& features, const cv::Rect& area) {
  return static_cast<int>(std::ranges::count_if(
      features.keypoints, [&](const cv::KeyPoint& k) { return area.contains(k.pt); }));
}

TEST(OrbExtractor, SpendsFeaturesOutsideTheSpareArea) {
  OrbExtractor extractor(OrbOptions{});
  const cv::Mat image = textured_image();
  const cv::Rect half(0, 0, kWidth / 2, kHeight);
  cv::Mat fallback(image.size(), CV_8U, cv::Scalar(0));
  fallback(half) = 255;
  EXPECT_GT(inside(extractor.extract(image), half), 350);
  const Features features = extractor.extract(image, fallback);
  EXPECT_EQ(features.size(), 1000U);
  // A pixel of the coarsest level is 3.6 px wide.
  EXPECT_EQ(inside(features, {0, 0, kWidth / 2 - 4, kHeight}), 0);
}

TEST(OrbExtractor, MakesUpForTheSpareArea) {
  OrbExtractor extractor(OrbOptions{});
  const cv::Mat image = textured_image();
  const cv::Rect half(0, 0, kWidth / 2, kHeight);
  cv::Mat fallback(image.size(), CV_8U, cv::Scalar(0));
  fallback(half) = 255;
  const Features features = extractor.extract(image, fallback, 1.5);
  EXPECT_NEAR(features.size(), 1500, 4);  // rounded on each level
  EXPECT_EQ(inside(features, {0, 0, kWidth / 2 - 4, kHeight}), 0);
}

TEST(OrbExtractor, TakesSpareFeaturesWhereOthersAreTooFew) {
  OrbExtractor extractor(OrbOptions{});
  cv::Mat image = textured_image();
  const cv::Rect half(0, 0, kWidth / 2, kHeight);
  image(cv::Rect(kWidth / 2, 0, kWidth / 2, kHeight - 100)) = 128;
  cv::Mat fallback(image.size(), CV_8U, cv::Scalar(0));
  fallback(half) = 255;
  const Features without = extractor.extract(image), features = extractor.extract(image, fallback);
  const int others = static_cast<int>(without.size()) - inside(without, half);
  EXPECT_GE(inside(features, half), 200);
  EXPECT_GT(static_cast<int>(features.size()) - inside(features, half), 3 * others / 2);
  EXPECT_EQ(extractor.extract(image, cv::Mat(image.size(), CV_8U, cv::Scalar(1))).keypoints.size(),
            without.keypoints.size());
  // Asked for more, the fallback area gives no more.
  EXPECT_EQ(inside(extractor.extract(image, fallback, 2.0), half), inside(features, half));
}

TEST(OrbExtractor, StaysInsideImagesOfAllSizes) {
  for (const cv::Size size : {cv::Size(39, 39), cv::Size(41, 127), cv::Size(101, 57),
                              cv::Size(321, 243), cv::Size(1001, 333)}) {
    OrbExtractor extractor(OrbOptions{});
    const Features features = extractor.extract(textured_image(size.width, size.height));
    EXPECT_EQ(features.keypoints.size(), features.descriptors.size());
    for (const cv::KeyPoint& k : features.keypoints) {
      const float border = 18.4F * static_cast<float>(std::pow(1.2, k.octave));
      EXPECT_GE(k.pt.x, border) << size << " level " << k.octave;
      EXPECT_GE(k.pt.y, border) << size << " level " << k.octave;
      EXPECT_LE(k.pt.x, static_cast<float>(size.width - 1) - border) << size;
      EXPECT_LE(k.pt.y, static_cast<float>(size.height - 1) - border) << size;
    }
  }
}

TEST(OrbExtractor, FindsNothingInFlatTinyOrEmptyImages) {
  OrbExtractor extractor(OrbOptions{});
  EXPECT_EQ(extractor.extract(cv::Mat(kHeight, kWidth, CV_8UC1, cv::Scalar(77))).size(), 0U);
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(38, 300), cv::Size(300, 38)})
    EXPECT_EQ(extractor.extract(textured_image(size.width, size.height)).size(), 0U) << size;
  EXPECT_EQ(extractor.extract(cv::Mat()).size(), 0U);
}

TEST(OrbExtractor, RefusesOtherImages) {
  OrbExtractor extractor(OrbOptions{});
  try {
    extractor.extract(cv::Mat(kHeight, kWidth, CV_8UC3));
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("got OpenCV type CV_8UC3"));
  }
  EXPECT_THROW(extractor.extract(cv::Mat(40, 40000, CV_8UC1, cv::Scalar(0))), Error);
}

}  // namespace
}  // namespace stillpoint::orb_slam
