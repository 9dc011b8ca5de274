// The same figures as the scripts of the TUM RGB-D benchmark, to every digit they print.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "evaluation/evaluation.hpp"
#include "evaluation/format.hpp"
#include "support/shared_data.hpp"

namespace stillpoint::evaluation {
namespace {

using Row = std::map<std::string, std::string>;

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> result;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) result.push_back(cell);
  return result;
}

std::vector<Row> read_table(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  const std::vector<std::string> header = cells(line);
  std::vector<Row> rows;
  while (std::getline(stream, line)) {
    const std::vector<std::string> values = cells(line);
    Row row;
    for (std::size_t i = 0; i < values.size(); ++i) row[header.at(i)] = values[i];
    rows.push_back(row);
  }
  return rows;
}

Row figures(const Trajectory& reference, const Trajectory& estimate) {
  EvaluationOptions options;
  const Evaluation second = evaluate(reference, estimate, {}, options);
  options.delta.unit = DeltaUnit::kFrames;
  const Evaluation frame = evaluate(reference, estimate, {}, options);
  const auto text = [](double value) { return fixed(value, 6); };
  const Statistics& ate = second.rigid.metres;
  const RelativeError &rpe_s = second.relative.value(), &rpe_f = frame.relative.value();
  return {{"ate_pairs", std::to_string(second.pairs.size())},
          {"ate_rmse", text(ate.rmse)},
          {"ate_mean", text(ate.mean)},
          {"ate_median", text(ate.median)},
          {"ate_std", text(ate.standard_deviation)},
          {"ate_min", text(ate.min)},
          {"ate_max", text(ate.max)},
          {"rpe1s_pairs", std::to_string(rpe_s.pairs)},
          {"rpe1s_t_rmse", text(rpe_s.translation_m.rmse)},
          {"rpe1s_t_mean", text(rpe_s.translation_m.mean)},
          {"rpe1s_r_rmse_deg", text(rpe_s.rotation_deg.rmse)},
          {"rpe1s_r_mean_deg", text(rpe_s.rotation_deg.mean)},
          {"rpe1f_pairs", std::to_string(rpe_f.pairs)},
          {"rpe1f_t_rmse", text(rpe_f.translation_m.rmse)},
          {"rpe1f_r_rmse_deg", text(rpe_f.rotation_deg.rmse)}};
}

// Rows whose files are missing are named and left out.
int compare_all_rows(const std::filesystem::path& folder) {
  int compared = 0;
  for (const Row& row : read_table(folder / "expected_tum_tools.csv")) {
    const std::filesystem::path reference = folder / row.at("groundtruth");
    const std::filesystem::path estimate = folder / row.at("estimate");
    if (!std::filesystem::exists(reference) || !std::filesystem::exists(estimate)) {
      std::cout << "left out, not there: " << row.at("estimate") << "\n";
      continue;
    }
    const Row found = figures(read_trajectory(reference), read_trajectory(estimate));
    for (const auto& [column, expected] : row) {
      if (column == "groundtruth" || column == "estimate") continue;
      EXPECT_EQ(found.at(column), expected) << row.at("estimate") << " " << column;
    }
    ++compared;
  }
  return compared;
}

TEST(TumBenchmark, PublishedTrajectoriesGiveThePrintedDigits) {
  const std::filesystem::path folder = testing::shared_data() / "data/trajectories";
  if (!std::filesystem::exists(folder / "expected_tum_tools.csv"))
    GTEST_SKIP() << "no published trajectories at " << folder << "; set STILLPOINT_SHARED";
  EXPECT_GT(compare_all_rows(folder), 0);
}

}  // namespace
}  // namespace stillpoint::evaluation
