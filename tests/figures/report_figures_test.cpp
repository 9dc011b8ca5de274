// The files that `stillpoint report --figures` leaves.
#include "report/figures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <fstream>
#include <set>
#include <sstream>

#include "stillpoint/error.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint::report {
namespace {

namespace fs = std::filesystem;
using ::testing::IsSupersetOf;
using ::testing::StartsWith;
using ::testing::UnorderedElementsAre;

/// 3 s of 30 frames each, along x, with everything that a report knows.
RunData run_of(const std::string& name, const std::string& recording) {
  RunData run{.name = name, .variant = name, .recording = recording};
  run.frames = 90;
  StageTimes stage{"track", 90, {5, 5, 6, 7, 8}, {4, 4, 5, 6, 7}, {}, {}, {}};
  for (std::uint32_t i = 0; i < 90; ++i) {
    const double s = i / 30.0;
    run.trace.push_back({s, {s, 0, 0}, {s, 0.01, 0}, 0.01, i == 45});
    run.drift.push_back({s, 0.02, 0.3});
    run.frame_rows.push_back({i, 100 + s, s, true, 1000, 500, 400, 3, 0.2});
    stage.frame.push_back(i);
    stage.wall_ms.push_back(5);
    stage.cpu_ms.push_back(4);
  }
  run.stages = {stage};
  run.lost = {{1, 1.5}};
  run.loops = {2.5};
  return run;
}

/// Relative to the folder, without the endings: every figure has both files.
std::set<std::string> figures_below(const fs::path& folder) {
  std::map<std::string, std::set<std::string>> endings;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    const fs::path file = fs::relative(entry.path(), folder);
    endings[(file.parent_path() / file.stem()).string()].insert(file.extension().string());
  }
  std::set<std::string> figures;
  for (const auto& [figure, formats] : endings) {
    EXPECT_THAT(formats, UnorderedElementsAre(".svg", ".pdf")) << figure;
    figures.insert(figure);
  }
  return figures;
}

std::string bytes_of(const fs::path& file) {
  std::ostringstream bytes;
  bytes << std::ifstream(file, std::ios::binary).rdbuf();
  return bytes.str();
}

class ReportFigures : public ::testing::Test {
 protected:
  std::set<std::string> written(const ReportData& data) {
    const std::size_t count = write_figures(data, folder_.path());
    std::set<std::string> figures = figures_below(folder_.path());
    EXPECT_EQ(figures.size(), count);
    return figures;
  }
  stillpoint::testing::TemporaryFolder folder_;
};

TEST_F(ReportFigures, OfARunAreInAFolderOfItsName) {
  ReportData data;
  data.runs = {run_of("out", "walking")};
  EXPECT_THAT(written(data),
              UnorderedElementsAre("walking/out/trajectory", "walking/out/errors",
                                   "walking/out/excluded", "walking/out/features",
                                   "walking/out/stage_times", "walking/out/frame_times"));
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_.path() / "walking/out")) {
    const std::string bytes = bytes_of(entry.path());
    if (entry.path().extension() == ".pdf") {
      EXPECT_THAT(bytes, StartsWith("%PDF-1."));
      continue;
    }
    std::istringstream stream(bytes);
    boost::property_tree::ptree tree;
    EXPECT_NO_THROW(boost::property_tree::read_xml(stream, tree)) << entry.path();
    EXPECT_FALSE(tree.get<std::string>("svg.title").empty()) << entry.path();
  }
}

TEST_F(ReportFigures, OfAStudyShowTheFirstRepeatOfEachVariant) {
  ReportData data;
  for (const char* name :
       {"walking/base/1", "walking/base/2", "walking/better/1", "sitting/base/1"}) {
    data.runs.push_back(run_of(name, std::string(name).substr(0, 7)));
    data.runs.back().variant =
        std::string(name).find("better") == std::string::npos ? "base" : "better";
  }
  const std::set<std::string> figures = written(data);
  EXPECT_THAT(figures,
              IsSupersetOf({"walking/trajectory", "walking/errors", "walking/excluded",
                            "walking/stage_times", "walking/base/errors", "walking/better/errors",
                            "sitting/base/errors", "stage_times"}));
  EXPECT_EQ(figures.size(), 1u + 4 + 3 * 6);
}

TEST_F(ReportFigures, TimeOfAVariantIsTheMeanOfItsRuns) {
  const auto picture = [&](double first, double second) {
    ReportData data;
    for (const auto& [name, ms] : {std::pair{"base/1", first}, {"base/2", second}, {"more/1", 9}}) {
      data.runs.push_back(run_of(name, "walking"));
      data.runs.back().variant = std::string(name).substr(0, 4);
      data.runs.back().stages[0].cpu.mean = ms;
    }
    written(data);
    return bytes_of(folder_.path() / "stage_times.svg");
  };
  EXPECT_EQ(picture(4, 8), picture(6, 6));
  EXPECT_NE(picture(4, 8), picture(4, 4));
}

TEST_F(ReportFigures, RunsOfOneNameAreToldApartAndNamesStayInTheFolder) {
  ReportData data;
  data.runs = {run_of("out", "walking"), run_of("out", "walking"), run_of("..", ".."),
               run_of("", "")};
  EXPECT_THAT(written(data), IsSupersetOf({"walking/out/errors", "walking/out_2/errors",
                                           "_/_/errors", "recording/_/errors"}));
}

TEST_F(ReportFigures, RunsWithLongNamesAreNoVariantsOfAStudy) {
  ReportData data;
  data.runs = {run_of("a/x/out", "walking"), run_of("b/x/out", "walking")};
  EXPECT_THAT(written(data), IsSupersetOf({"walking/a_x_out/errors", "walking/b_x_out/errors"}));
}

TEST_F(ReportFigures, WithoutDataThereIsNone) {
  ReportData data;
  data.runs = {RunData{.name = "failed", .recording = "walking"}};
  EXPECT_TRUE(written(data).empty());
}

TEST_F(ReportFigures, WithoutTruthThereIsThePath) {
  RunData run = run_of("out", "walking");
  run.trace.clear();
  run.drift.clear();
  for (int i = 0; i < 30; ++i)
    run.path.push_back({1.5e9 + i, Pose(Eigen::Translation3d(0.1 * i, 0, 0))});
  ReportData data;
  data.runs = {run};
  const std::set<std::string> figures = written(data);
  EXPECT_TRUE(figures.contains("walking/out/trajectory"));
  EXPECT_FALSE(figures.contains("walking/out/errors"));
}

TEST_F(ReportFigures, AFolderThatCannotBeMadeIsAnError) {
  ReportData data;
  data.runs = {run_of("out", "walking")};
  folder_.write("file", "");
  EXPECT_THROW(write_figures(data, folder_.path() / "file"), Error);
}

}  // namespace
}  // namespace stillpoint::report
