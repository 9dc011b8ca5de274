// All checkers on scenes of known motion, and on images that show nothing.
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "moving_checks/lk_checker.hpp"
#include "moving_checks/rgbd_checker.hpp"
#include "moving_checks/test_scene.hpp"

namespace stillpoint::moving_checks {
namespace {

std::unique_ptr<MovingChecker> make(const std::string& type) {
  StageContext context;
  context.seed = 3;
  if (type == "lk_epipolar") return std::make_unique<LkEpipolar>(LkEpipolar::Options{}, context);
  if (type == "lk_usac") return std::make_unique<LkUsac>(LkUsac::Options{}, context);
  if (type == "lk_magsac") return std::make_unique<LkMagsac>(LkMagsac::Options{}, context);
  if (type == "lk_homography") return std::make_unique<LkHomography>(LkHomography::Options{});
  return std::make_unique<RgbdChecker>(RgbdChecker::Options{}, context);
}

// Where the moving board of the scene is seen, without its edges.
cv::Rect2f seen(const Board& board, const Camera& camera, const Pose& world_from_camera) {
  const Pose camera_from_world = world_from_camera.inverse();
  const Eigen::Vector3d half(board.width / 2 - 0.1, board.height / 2 - 0.1, 0);
  const Eigen::Vector2d a = camera.project(camera_from_world * (board.centre - half));
  const Eigen::Vector2d b = camera.project(camera_from_world * (board.centre + half));
  return {cv::Point2f(a.x(), a.y()), cv::Point2f(b.x(), b.y())};
}

struct Share {
  int points = 0, moving = 0;
  double share() const { return points == 0 ? 0.0 : 1.0 * moving / points; }
};

// Of the points of which `inside` of the rectangle is as given; those at its edge do not count.
Share share_of(const MovingPoints& result, const cv::Rect2f& area, bool inside) {
  Share share;
  const cv::Rect2f around(area.x - 30, area.y - 30, area.width + 60, area.height + 60);
  for (const PointMotion& point : result.points) {
    if (inside ? !area.contains(point.previous) : around.contains(point.previous)) continue;
    ++share.points;
    share.moving += point.moving;
  }
  return share;
}

Share everywhere(const MovingPoints& result) { return share_of(result, {}, false); }

class AnyChecker : public ::testing::TestWithParam<std::string> {
 protected:
  std::unique_ptr<MovingChecker> checker_ = make(GetParam());
};
INSTANTIATE_TEST_SUITE_P(All, AnyChecker,
                         ::testing::Values("lk_epipolar", "lk_usac", "lk_magsac", "lk_homography",
                                           "rgbd_reprojection"),
                         [](const auto& test) { return test.param; });

TEST_P(AnyChecker, TurningCameraFindsNothingMoving) {
  const TestScene scene = TestScene::room();
  const Frame previous = scene.render(camera_at(0, 0, 0), 0);
  const Frame current = scene.render(camera_at(0, 0, 0, 0.02, 0.01), 1);
  const MovingPoints result = checker_->check(previous, current, {});
  EXPECT_GT(result.points.size(), 60u);
  EXPECT_TRUE(!result.reliable || everywhere(result).share() < 0.03);
}

TEST_P(AnyChecker, TwiceTheSameIsTwiceTheSame) {
  TestScene scene = TestScene::room();
  const Frame previous = scene.render(camera_at(0, 0, 0), 0);
  scene.boards[3].centre.x() += 0.05;
  const Frame current = scene.render(camera_at(0.05, 0, 0.01), 1);
  const MovingPoints first = checker_->check(previous, current, {});
  const MovingPoints again = checker_->check(previous, current, {});
  const MovingPoints other = make(GetParam())->check(previous, current, {});
  for (const MovingPoints* result : {&again, &other}) {
    EXPECT_EQ(result->reliable, first.reliable);
    ASSERT_EQ(result->points.size(), first.points.size());
    for (std::size_t i = 0; i < first.points.size(); ++i) {
      EXPECT_EQ(result->points[i].current, first.points[i].current);
      EXPECT_EQ(result->points[i].residual, first.points[i].residual);
      EXPECT_EQ(result->points[i].moving, first.points[i].moving);
    }
  }
}

TEST_P(AnyChecker, ImagesThatShowNothingDecideNothing) {
  const TestScene scene = TestScene::room();
  const Frame good = scene.render(camera_at(0, 0, 0), 0);
  const auto frame_of = [&](const cv::Size& size, const cv::Scalar& gray) {
    return Frame{.index = 1,
                 .bgr = cv::Mat(size, CV_8UC3, gray),
                 .gray = cv::Mat(size, CV_8UC1, gray),
                 .depth = cv::Mat::zeros(size, CV_32FC1),
                 .camera = good.camera};
  };
  const Frame black = frame_of(good.gray.size(), 0);
  const Frame dot = frame_of({1, 1}, 255);
  const Frame narrow = frame_of({320, 3}, 100);
  const Frame none;
  for (const Frame* a : {&good, &black, &dot, &narrow, &none})
    for (const Frame* b : {&black, &dot, &narrow, &none}) {
      const MovingPoints result = checker_->check(*a, *b, {});
      EXPECT_FALSE(result.reliable);
      EXPECT_EQ(everywhere(result).moving, 0);
    }
  EXPECT_NO_THROW(checker_->check(black, good, {}));
}

TEST_P(AnyChecker, PointsStayInsideTheImage) {
  const TestScene scene = TestScene::room();
  const Frame previous = scene.render(camera_at(0, 0, 0), 0);
  const Frame current = scene.render(camera_at(0.2, 0.1, 0, 0.1), 3);
  for (const PointMotion& point : checker_->check(previous, current, {}).points)
    for (const cv::Point2f& p : {point.previous, point.current})
      EXPECT_TRUE(scene.camera().contains(p.x, p.y, 5)) << p;
}

class FundamentalChecker : public AnyChecker {};
INSTANTIATE_TEST_SUITE_P(All, FundamentalChecker,
                         ::testing::Values("lk_epipolar", "lk_usac", "lk_magsac"),
                         [](const auto& test) { return test.param; });

TEST_P(FundamentalChecker, FindsTheBoardThatMovesAcrossItsEpipolarLines) {
  TestScene scene = TestScene::room();
  const Pose before = camera_at(0, 0, 0);
  const Frame previous = scene.render(before, 0);
  const cv::Rect2f area = seen(scene.boards[3], scene.camera(), before);
  scene.boards[3].centre.y() -= 0.06;
  const Frame current = scene.render(camera_at(0.12, 0, 0), 1);
  const MovingPoints result = checker_->check(previous, current, {});
  ASSERT_TRUE(result.reliable);
  EXPECT_GT(share_of(result, area, true).points, 5);
  EXPECT_GT(share_of(result, area, true).share(), 0.5);
  EXPECT_LT(share_of(result, area, false).share(), 0.1);
}

TEST_P(FundamentalChecker, DecidesNothingWithoutParallax) {
  const TestScene room = TestScene::room();
  TestScene wall = room;
  wall.boards.resize(1);
  const Frame start = room.render(camera_at(0, 0, 0), 0);
  EXPECT_FALSE(checker_->check(start, room.render(camera_at(0, 0, 0), 1), {}).reliable);
  EXPECT_FALSE(checker_->check(start, room.render(camera_at(0, 0, 0, 0.02, 0.01), 2), {}).reliable);
  EXPECT_FALSE(
      checker_->check(wall.render(camera_at(0, 0, 0), 3), wall.render(camera_at(0.1, 0, 0), 4), {})
          .reliable);
}

TEST(LkEpipolar, JudgesByTheHomographyWhereTheOptionSaysSo) {
  TestScene scene = TestScene::room();
  const Frame previous = scene.render(camera_at(0, 0, 0), 0);
  const cv::Rect2f area = seen(scene.boards[3], scene.camera(), camera_at(0, 0, 0));
  scene.boards[3].centre.x() += 0.05;
  const Frame current = scene.render(camera_at(0, 0, 0, 0.02), 1);
  LkEpipolar checker({.when_degenerate = EpipolarChecker::Degenerate::kHomography}, {});
  const MovingPoints result = checker.check(previous, current, {});
  ASSERT_TRUE(result.reliable);
  EXPECT_GT(share_of(result, area, true).share(), 0.9);
  EXPECT_LT(share_of(result, area, false).share(), 0.03);
}

TEST(LkEpipolar, DecidesOnParallaxItIsToldToIgnore) {
  const TestScene scene = TestScene::room();
  LkEpipolar checker({.when_degenerate = EpipolarChecker::Degenerate::kIgnore}, {});
  EXPECT_TRUE(
      checker.check(scene.render(camera_at(0, 0, 0), 0), scene.render(camera_at(0, 0, 0), 1), {})
          .reliable);
}

}  // namespace
}  // namespace stillpoint::moving_checks
