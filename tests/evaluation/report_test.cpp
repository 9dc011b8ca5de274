#include "evaluation/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "fixtures.hpp"

namespace stillpoint::evaluation {
namespace {

using testing::HasSubstr;

// Hand-made recording: a square walked in 8 s, the estimate 2 cm off at one corner.
const std::filesystem::path kData = STILLPOINT_SOURCE_DIR "/tests/evaluation/data";

Evaluation of_square() {
  return evaluate(read_trajectory(kData / "square_reference.txt"),
                  read_trajectory(kData / "square_estimate.txt"),
                  read_stamps(kData / "square_frames.txt"), {});
}

TEST(Report, TableShowsTheFiguresOfTheSquare) {
  const std::string table = report_table(of_square());
  EXPECT_THAT(table, HasSubstr("9 of 9 estimated poses"));
  EXPECT_THAT(table, HasSubstr("90.0 % of the frames (9 of 10)"));
  EXPECT_THAT(table, HasSubstr("RMSE        mean      median        S.D.         min         max"));
}

TEST(Report, JsonHoldsTheFiguresOfTheTable) {
  const Evaluation e = of_square();
  const nlohmann::ordered_json json = report_json(e);
  EXPECT_EQ(json["pairs"], 9);
  EXPECT_EQ(json["coverage"]["frames"], 0.9);
  EXPECT_EQ(json["ate"]["se3_m"]["rmse"], e.rigid.metres.rmse);
  EXPECT_EQ(json["rpe"]["pairs"], 7);
  // The corner is reached and left with 2 cm too much; five of the seven steps are exact.
  EXPECT_NEAR(json["rpe"]["translation_m"]["max"], 0.02, 1e-9);
  EXPECT_NEAR(json["rpe"]["translation_m"]["mean"], 2 * 0.02 / 7, 1e-9);
  EXPECT_NEAR(json["rpe"]["rotation_deg"]["max"], 0, 1e-9);
}

TEST(Report, FiguresThatPositionsDoNotDetermineAreLeftOut) {
  Trajectory path = winding_path(100, 0.1), estimate = path;
  for (std::size_t i = 0; i < 100; ++i) {
    path.poses[i].world_from_camera.translation() *= 1e-3;
    estimate.poses[i].world_from_camera.translation() *= i % 2 == 0 ? 2e-2 : -2e-2;
  }
  const Evaluation e = evaluate(path, estimate, {}, {});
  EXPECT_THAT(report_table(e), testing::AllOf(HasSubstr("the path is too short or too straight"),
                                              HasSubstr("scale –: the path is too short for it")));
  EXPECT_TRUE(report_json(e)["ate"]["sim3_scale"].is_null());
  EXPECT_TRUE(report_json(e)["ate"]["se3_deg"].is_null());
}

TEST(Report, LargeErrorsKeepTheirColumns) {
  Trajectory path = winding_path(100, 0.1), estimate = path;
  for (std::size_t i = 0; i < 100; ++i)
    estimate.poses[i].world_from_camera.translation().x() += 1000.0 * static_cast<double>(i % 2);
  EXPECT_THAT(report_table(evaluate(path, estimate, {}, {})),
              testing::ContainsRegex("m +[0-9.]+ +[0-9.]+ +[0-9.]+ +[0-9.]+ +[0-9.]+ +[0-9.]+\n"));
}

TEST(Report, ShortTrajectoriesHaveNoRelativeErrorInEither) {
  const Trajectory path = winding_path(10, 0.05);
  const Evaluation e = evaluate(path, path, {}, {});
  EXPECT_THAT(report_table(e), HasSubstr("RPE over 1 s: the trajectories are too short"));
  EXPECT_TRUE(report_json(e)["rpe"]["translation_m"].is_null());
}

}  // namespace
}  // namespace stillpoint::evaluation
