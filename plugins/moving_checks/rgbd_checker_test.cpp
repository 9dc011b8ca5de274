#include "moving_checks/rgbd_checker.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "moving_checks/test_scene.hpp"

namespace stillpoint::moving_checks {
namespace {

struct Counts {
  int on_board = 0, found = 0, elsewhere = 0, wrong = 0;
};

// Points on the board, 12 px off its edge, and points elsewhere; `slack` px beside it count as
// neither.
Counts count(const MovingPoints& result, const Board& board, const Camera& camera,
             const Pose& world_from_camera, double slack = 25) {
  Counts counts;
  const Pose camera_from_world = world_from_camera.inverse();
  const Eigen::Vector3d half(board.width / 2, board.height / 2, 0);
  const Eigen::Vector2d low = camera.project(camera_from_world * (board.centre - half));
  const Eigen::Vector2d high = camera.project(camera_from_world * (board.centre + half));
  for (const PointMotion& point : result.points) {
    const Eigen::Array2d p(point.previous.x, point.previous.y);
    const double inside = std::min((p - low.array()).minCoeff(), (high.array() - p).minCoeff());
    if (inside > 12) {
      ++counts.on_board;
      counts.found += point.moving;
    } else if (inside < -slack) {
      ++counts.elsewhere;
      counts.wrong += point.moving;
    }
  }
  return counts;
}

class RgbdCheckerTest : public ::testing::Test {
 protected:
  // The first board of the room's foreground moves by `step` while the camera goes to `after`.
  Counts move_board(const Eigen::Vector3d& step, const Pose& after) {
    const Pose before = camera_at(0, 0, 0);
    const Frame previous = scene_.render(before, 0);
    const Board board = scene_.boards[3];
    scene_.boards[3].centre += step;
    const MovingPoints result = checker_.check(previous, scene_.render(after, 1), {});
    EXPECT_TRUE(result.reliable);
    return count(result, board, scene_.camera(), before);
  }

  TestScene scene_ = TestScene::room();
  RgbdChecker checker_{RgbdChecker::Options{}, StageContext{}};
};

TEST_F(RgbdCheckerTest, FindsWhatMovesWhileTheCameraTurns) {
  const Counts counts = move_board({0.06, 0, 0}, camera_at(0, 0, 0, 0.03, 0.01));
  EXPECT_GT(counts.on_board, 5);
  EXPECT_GT(counts.found, 0.9 * counts.on_board);
  EXPECT_EQ(counts.wrong, 0);
}

TEST_F(RgbdCheckerTest, FindsWhatMovesAlongItsEpipolarLine) {
  const Counts counts = move_board({0.12, 0, 0}, camera_at(0.06, 0, 0));
  EXPECT_GT(counts.found, 0.9 * counts.on_board);
  EXPECT_EQ(counts.wrong, 0);
}

TEST_F(RgbdCheckerTest, FindsWhatComesNearer) {
  const Counts counts = move_board({0, 0, -0.2}, camera_at(0, 0, 0));
  EXPECT_GT(counts.found, 0.8 * counts.on_board);
  EXPECT_EQ(counts.wrong, 0);
}

TEST_F(RgbdCheckerTest, FindsWhatMovesBeforeOnePlane) {
  scene_.boards[1] = scene_.boards[2] = scene_.boards[0];
  const Counts counts = move_board({0, 0.06, 0}, camera_at(0.05, 0.02, 0));
  EXPECT_GT(counts.found, 0.9 * counts.on_board);
  EXPECT_EQ(counts.wrong, 0);
}

TEST_F(RgbdCheckerTest, StaticWorldStaysStaticWhateverTheCameraDoes) {
  const Frame start = scene_.render(camera_at(0, 0, 0), 0);
  for (const Pose& pose : {camera_at(0, 0, 0), camera_at(0.03, -0.02, 0.05, 0.01),
                           camera_at(0, 0, 0, 0.08, 0.04), camera_at(0.06, 0.03, 0.05, -0.03)}) {
    RgbdChecker checker({}, {});
    const MovingPoints result = checker.check(start, scene_.render(pose, 5), {});
    EXPECT_TRUE(result.reliable);
    EXPECT_LT(std::count_if(result.points.begin(), result.points.end(),
                            [](const PointMotion& p) { return p.moving; }),
              0.03 * result.points.size());
  }
}

TEST_F(RgbdCheckerTest, StaticWorldOfANoisySensorIsUsefulWhenItsNoiseIsKnown) {
  constexpr double kNoise = 0.02;  // 1/m, of the inverse depth: ten times a Kinect's
  const auto check = [&](double known_noise) {
    auto camera = std::make_shared<Camera>(scene_.camera());
    camera->surface_noise = known_noise;
    cv::RNG random(3);
    const auto render = [&](const Pose& pose, std::uint32_t index) {
      Frame frame = scene_.render(pose, index);
      frame.camera = camera;
      for (auto z = frame.depth.begin<float>(); z != frame.depth.end<float>(); ++z)
        if (*z > 0) *z = static_cast<float>(1 / (1 / *z + random.gaussian(kNoise)));
      return frame;
    };
    RgbdChecker checker({}, {});
    const Frame before = render(camera_at(0, 0, 0), 0);
    return checker.check(before, render(camera_at(0.03, -0.02, 0.05), 1), {});
  };
  EXPECT_FALSE(check(0.002).reliable) << "noise is taken for edges";
  const MovingPoints known = check(kNoise);
  EXPECT_TRUE(known.reliable);
  EXPECT_LT(std::ranges::count_if(known.points, &PointMotion::moving), 0.03 * known.points.size());
}

// What has stood still before decides whose motion is the camera's, though most of the picture
// moves as one thing now.
TEST_F(RgbdCheckerTest, BoardThatFillsMoreThanHalfOfThePictureIsWhatMoves) {
  scene_.boards.push_back({{-3.4, 0, 1.8}, 2.4, 3.0, 0.012, 9});
  const auto frame = [&](std::uint32_t i) { return scene_.render(camera_at(0.004 * i, 0, 0), i); };
  Frame previous = frame(0);
  for (std::uint32_t i = 1; i < 39; ++i) {
    const Board board = scene_.boards.back();
    scene_.boards.back().centre.x() += 0.07;
    const Frame current = frame(i);
    const MovingPoints result = checker_.check(previous, current, {});
    const Counts counts =
        count(result, board, scene_.camera(), camera_at(0.004 * (i - 1), 0, 0), 40);
    if (result.reliable) {
      EXPECT_LE(counts.wrong, 0.1 * counts.elsewhere) << "frame " << i;
      EXPECT_GE(counts.found, 0.7 * counts.on_board - 2) << "frame " << i;
    }
    previous = current;
  }
}

// When the exposure jumps, hardly any point is found again: what moved before is still known.
TEST_F(RgbdCheckerTest, AJumpOfExposureIsNotForgetting) {
  scene_.boards.push_back({{-3.4, 0, 1.8}, 2.4, 3.0, 0.012, 9});
  const auto frame = [&](std::uint32_t i) { return scene_.render(camera_at(0.004 * i, 0, 0), i); };
  constexpr std::uint32_t kBright = 32;
  Frame previous = frame(0);
  int reliable = 0;
  for (std::uint32_t i = 1; i < 42; ++i) {
    const Board board = scene_.boards.back();
    scene_.boards.back().centre.x() += 0.07;
    Frame current = frame(i);
    if (i == kBright) current.gray = current.gray + 70;
    const MovingPoints result = checker_.check(previous, current, {});
    if (i == kBright) {
      EXPECT_FALSE(result.reliable);
    }
    if (i > kBright + 1 && result.reliable) {
      const Counts counts =
          count(result, board, scene_.camera(), camera_at(0.004 * (i - 1), 0, 0), 40);
      EXPECT_LE(counts.wrong, 0.1 * counts.elsewhere) << "frame " << i;
      EXPECT_GE(counts.found, 0.7 * counts.on_board - 2) << "frame " << i;
      ++reliable;
    }
    previous = current;
  }
  EXPECT_GT(reliable, 5);
}

// As when a person passes close by: what is static is seen on one side only, and places the points
// of the other side less well, but well enough.
TEST_F(RgbdCheckerTest, FindsWhatMovesBesideAllThatIsStatic) {
  scene_.boards = {{{-3.7, 0, 4}, 6, 9, 0.02, 1}};  // the left third of the picture
  const auto eye = [](std::uint32_t i) { return camera_at(0.005 * i, 0, 0); };
  Frame previous = scene_.render(eye(0), 0);
  for (std::uint32_t i = 1; i < 12; ++i) {
    if (i == 5) scene_.boards.push_back({{0.8, -0.3, 2}, 1.4, 1.6, 0.012, 5});
    const Board passing = scene_.boards.back();
    if (i > 5) scene_.boards.back().centre.y() += 0.07;
    const Frame current = scene_.render(eye(i), i);
    const MovingPoints result = checker_.check(previous, current, {});
    EXPECT_TRUE(result.reliable) << "frame " << i;
    if (i > 5) {
      const Counts counts = count(result, passing, scene_.camera(), eye(i - 1));
      EXPECT_EQ(counts.wrong, 0) << "frame " << i;
      EXPECT_GE(counts.found, 0.8 * counts.on_board) << "frame " << i;
    }
    previous = current;
  }
}

TEST_F(RgbdCheckerTest, PointsAtDepthEdgesDoNotMove) {
  const Pose before = camera_at(0, 0, 0);
  const Frame previous = scene_.render(before, 0);
  scene_.boards[3].centre.x() += 0.06;
  const Frame current = scene_.render(before, 1);
  for (const PointMotion& point : checker_.check(previous, current, {}).points) {
    if (!point.moving) continue;
    const cv::Rect around(cvRound(point.previous.x) - 2, cvRound(point.previous.y) - 2, 5, 5);
    double low = 0;
    double high = 0;
    cv::minMaxLoc(previous.depth(around), &low, &high);
    EXPECT_LT(high - low, 0.1) << point.previous;
  }
}

TEST_F(RgbdCheckerTest, PointsWithoutDepthAreJudgedWhereTheirPlaceIsCertain) {
  scene_.boards[0].measured = false;  // the wall
  const Pose before = camera_at(0, 0, 0);
  const Frame previous = scene_.render(before, 0);
  const MovingPoints turned =
      checker_.check(previous, scene_.render(camera_at(0, 0, 0, 0.02), 1), {});
  ASSERT_TRUE(turned.reliable);
  for (const PointMotion& point : turned.points) EXPECT_FALSE(point.moving);
  scene_.boards[0].centre.x() += 0.1;
  const MovingPoints slid = checker_.check(previous, scene_.render(before, 2), {});
  ASSERT_TRUE(slid.reliable);
  EXPECT_TRUE(std::any_of(slid.points.begin(), slid.points.end(),
                          [](const PointMotion& point) { return point.moving; }));
}

TEST_F(RgbdCheckerTest, DecidesNothingWithoutDepth) {
  Frame previous = scene_.render(camera_at(0, 0, 0), 0);
  Frame current = scene_.render(camera_at(0.02, 0, 0), 1);
  current.depth = cv::Mat::zeros(current.depth.size(), CV_32FC1);
  EXPECT_FALSE(checker_.check(previous, current, {}).reliable);
  current.depth = cv::Mat();
  EXPECT_FALSE(checker_.check(previous, current, {}).reliable);
  current.depth = cv::Mat::ones(previous.depth.size(), CV_32FC1);
  current.camera = nullptr;
  EXPECT_FALSE(checker_.check(previous, current, {}).reliable);
}

TEST_F(RgbdCheckerTest, DecidesNothingWhenNothingAgrees) {
  Frame previous = scene_.render(camera_at(0, 0, 0), 0);
  Frame current = scene_.render(camera_at(0, 0, 0), 1);
  cv::RNG random(1);
  random.fill(current.depth, cv::RNG::UNIFORM, 0.5, 5.0);
  EXPECT_FALSE(checker_.check(previous, current, {}).reliable);
}

}  // namespace
}  // namespace stillpoint::moving_checks
