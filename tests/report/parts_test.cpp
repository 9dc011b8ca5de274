// The parts of a report: tables that the program has written, options, thinning, packing, maps.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <libdeflate.h>
#include <sys/stat.h>

#include <nlohmann/json.hpp>
#include <numeric>

#include "report/frame_log.hpp"
#include "report/map_voxels.hpp"
#include "report/option_changes.hpp"
#include "report/packing.hpp"
#include "report/page_json.hpp"
#include "report/picture_choice.hpp"
#include "report/thinning.hpp"
#include "semantic_octree/map_files.hpp"
#include "stillpoint/error.hpp"
#include "study/text_file.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint::report {
namespace {

using stillpoint::testing::TemporaryFolder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string message_of(const std::function<void()>& function) {
  try {
    function();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(FrameLog, ReadsFramesAndNamesTheLineThatIsNone) {
  const TemporaryFolder folder;
  const std::string header =
      "frame,time,state,features,matches,inliers,moving_points,excluded_percent\n";
  folder.write("frames.csv",
               header + "7,1.5,tracking,900,200,150,3,25.00\n8,1.6,LOST,0,0,0,,0.00\n");
  const std::vector<FrameRow> rows = read_frames(folder.path() / "frames.csv");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].frame, 7u);
  EXPECT_TRUE(rows[0].tracked);
  EXPECT_EQ(rows[0].moving_points, 3);
  EXPECT_DOUBLE_EQ(rows[0].excluded, 0.25);
  EXPECT_FALSE(rows[1].tracked);
  EXPECT_FALSE(rows[1].moving_points);
  EXPECT_TRUE(read_frames(folder.path() / "none.csv").empty());

  folder.write("frames.csv", header + "7,1.5,tracking,900,many,150,3,25.00\n");
  EXPECT_THAT(message_of([&] { read_frames(folder.path() / "frames.csv"); }),
              HasSubstr("frames.csv:2: 'many' is not a number"));
  folder.write("frames.csv", header + "7,1.5,trac");  // the end of a disk
  EXPECT_THAT(message_of([&] { read_frames(folder.path() / "frames.csv"); }),
              HasSubstr("frames.csv:2: there are not as many fields as columns"));
  folder.write("frames.csv", "frame,time\n");
  EXPECT_THAT(message_of([&] { read_frames(folder.path() / "frames.csv"); }),
              HasSubstr("frames.csv:1: the columns are not"));
}

TEST(ReportParts, DoNotWaitForPipes) {
  const TemporaryFolder folder;
  const auto pipe = folder.path() / "timings.csv";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THROW(read_stage_times(pipe), Error);
  EXPECT_EQ(study::read_text(pipe), "");
  EXPECT_EQ(study::read_text("/dev/zero"), "");
}

TEST(FrameLog, AddsUpTheCallsForOneFrame) {
  const TemporaryFolder folder;
  folder.write("timings.csv",
               "frame,stage,wall_ms,cpu_ms\n0,track,10.0,8.0\n0,map_check,1.0,1.0\n"
               "1,track,20.0,16.0\n0,map_check,2.0,1.5\n");
  const std::vector<StageTimes> stages = read_stage_times(folder.path() / "timings.csv");
  ASSERT_EQ(stages.size(), 2u);
  EXPECT_EQ(stages[0].stage, "map_check");  // as the pipeline calls them
  EXPECT_EQ(stages[0].calls, 2u);
  EXPECT_THAT(stages[0].frame, ElementsAre(0u));
  EXPECT_THAT(stages[0].wall_ms, ElementsAre(3.0F));
  EXPECT_THAT(stages[1].cpu_ms, ElementsAre(8.0F, 16.0F));
  EXPECT_DOUBLE_EQ(stages[1].wall.max, 20.0);
}

TEST(OptionChanges, AreWhatDiffersButTheRecordingAndTheSeed) {
  const auto changes = option_changes(
      "source: {path: /a}\ntracker: {type: orb, features: 1000}\nruntime: {seed: 1}\n"
      "outputs: [{type: trajectory}]\nloop_closer: {type: orb}\n",
      "source: {path: /b}\ntracker: {type: orb, features: 2000, sizes: [1, 2]}\n"
      "runtime: {seed: 3}\noutputs: [{type: summary}]\n");
  std::vector<std::string> texts;
  for (const OptionChange& change : changes)
    texts.push_back(change.key + ": " + change.base + " -> " + change.value);
  EXPECT_THAT(texts,
              ElementsAre("tracker.features: 1000 -> 2000", "tracker.sizes:  -> [1, 2]",
                          "outputs[0].type: trajectory -> summary", "loop_closer.type: orb -> "));
  EXPECT_THAT(message_of([] { option_changes("a: [", "a: 1"); }), HasSubstr("is no YAML"));
  std::string bomb = "a0: &a0 {x: 1}\n";
  for (int i = 1; i < 12; ++i) {
    const std::string one = "*a" + std::to_string(i - 1);
    bomb += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " {x: " + one;
    for (const char* key : {"b", "c", "d", "e", "f", "g", "h", "i"})
      bomb += std::string(", ") + key + ": " + one;
    bomb += "}\n";
  }
  EXPECT_THAT(message_of([&] { option_changes(bomb, "a: 1"); }), HasSubstr("more than 20,000"));
  EXPECT_EQ(recording_of_pipeline("source: {path: /a}"), "/a");
  EXPECT_EQ(recording_of_pipeline("source: {type: x}"), "");
  EXPECT_EQ(recording_of_pipeline("source: ["), "");
  EXPECT_EQ(live_view_of_pipeline("outputs: [{type: web, port: 0}, {type: web, record: a.html}]"),
            "a.html");
  for (const char* without : {"outputs: [{type: web}]", "outputs: []", "source: 1", "outputs: ["})
    EXPECT_EQ(live_view_of_pipeline(without), "") << without;
}

TEST(Thinning, KeepsPeaks) {
  std::vector<int> values(1000);
  std::iota(values.begin(), values.end(), 0);
  values[501] = 5000;
  const auto kept = thinned(values.size(), 10, [&](std::size_t i) { return values[i]; });
  ASSERT_EQ(kept.size(), 10u);
  EXPECT_EQ(kept[5], 501u);
  EXPECT_EQ(kept[9], 999u);
  EXPECT_EQ(thinned(3, 10, [](std::size_t) { return 0; }).size(), 3u);
}

TEST(Packing, WhatIsPackedIsUnpackedAgain) {
  std::string text;
  for (int i = 0; i < 10'000; ++i) text += std::to_string(i * i);
  const std::string packed = gzipped(text);
  EXPECT_LT(packed.size(), text.size());
  std::string again(text.size(), ' ');
  libdeflate_decompressor* decompressor = libdeflate_alloc_decompressor();
  EXPECT_EQ(libdeflate_gzip_decompress(decompressor, packed.data(), packed.size(), again.data(),
                                       again.size(), nullptr),
            LIBDEFLATE_SUCCESS);
  libdeflate_free_decompressor(decompressor);
  EXPECT_EQ(again, text);
}

/// A wall of 20 x 20 voxels of 5 cm, with a red one in a corner.
std::filesystem::path write_wall(const TemporaryFolder& folder) {
  semantic_octree::SemanticOctree tree(0.05);
  for (int x = 0; x < 20; ++x)
    for (int y = 0; y < 20; ++y) {
      auto* voxel =
          tree.updateNode(octomap::point3d(0.025F + 0.05F * static_cast<float>(x),
                                           0.025F + 0.05F * static_cast<float>(y), 1.025F),
                          x == 0 && y == 0 ? 3.0F : 1.0F);
      voxel->setColor(x == 0 && y == 0 ? 255 : 10, 20, 30);
      voxel->set_classes(semantic_octree::ClassBelief::of(x < 10 ? 0 : 1, 200));
    }
  const std::filesystem::path file = folder.path() / "map.ot";
  semantic_octree::write_octree(
      tree, semantic_octree::with_colors(ClassNames{"background", "person"}), file);
  return file;
}

TEST(MapVoxels, AreThoseOfTheMap) {
  const TemporaryFolder folder;
  const MapVoxels voxels = read_voxels(write_wall(folder), 1000);
  ASSERT_EQ(voxels.size(), 400u);
  EXPECT_EQ(voxels.occupied, 400u);
  EXPECT_DOUBLE_EQ(voxels.edge, 0.05);
  EXPECT_NEAR(voxels.corner.z(), 1.0, 1e-6);
  EXPECT_EQ(*std::ranges::max_element(voxels.x), 19);
  EXPECT_EQ(*std::ranges::max_element(voxels.z), 0);
  EXPECT_EQ(std::ranges::count(voxels.label, 1), 200);
  EXPECT_EQ(std::ranges::count(voxels.red, 255), 1);
  EXPECT_EQ(map_bytes(voxels).size(), 11u * 400u);
}

TEST(MapVoxels, TooManyBecomeLargerCubes) {
  const TemporaryFolder folder;
  const MapVoxels voxels = read_voxels(write_wall(folder), 30);
  EXPECT_DOUBLE_EQ(voxels.edge, 0.2);
  EXPECT_EQ(voxels.size(), 25u);
  EXPECT_EQ(voxels.occupied, 400u);
  EXPECT_EQ(std::ranges::count(voxels.red, 255), 1);  // the most probable looks of its cube
}

/// Ten seconds, with pictures of every tenth frame; frame 52 has the largest error.
RunData run_with_pictures(const TemporaryFolder& folder) {
  for (int i = 0; i < 100; i += 10)
    folder.write("images/0000" + std::string(i < 10 ? "0" : "") + std::to_string(i) + ".jpg", "x");
  folder.write("images/notes.txt", "x");
  RunData run{.folder = folder.path()};
  for (std::uint32_t i = 0; i < 100; ++i)
    run.frame_rows.push_back({.frame = i,
                              .time = 1000.0 + 0.1 * i,
                              .seconds = 0.1 * i,
                              .tracked = true,
                              .matches = 90,
                              .inliers = 80 - (i == 20 ? 40 : 0),
                              .excluded = 0.0});
  run.trace.push_back({.seconds = 5.2, .error_m = 0.0421});
  return run;
}

std::vector<std::string> texts_of(const RunData& run) {
  std::vector<std::string> texts;
  for (const Picture& picture : run.pictures)
    texts.push_back(std::to_string(picture.frame) + " " + picture.why);
  return texts;
}

TEST(PictureChoice, HasEvenOnesAndThoseBesideTheWorstMoments) {
  const TemporaryFolder folder;
  RunData run = run_with_pictures(folder);
  run.dataset = folder.path() / "none";
  choose_pictures(run);
  // 0 and 10 are the next ones with the fewest inliers: at least a second apart.
  EXPECT_THAT(texts_of(run),
              ElementsAre("0 few inliers: 80", "10 few inliers: 80", "20 fewest inliers: 40", "30 ",
                          "50 largest error: 42.1 mm (in frame 52)", "60 ", "80 "));
  EXPECT_EQ(run.pictures[2].state, "40 of 90 matches fit, 0.0 % not used");
}

TEST(PictureChoice, AWorstFrameThatWasNotDrawnIsShownAsRecorded) {
  const TemporaryFolder folder;
  std::string list;
  for (int i = 0; i < 100; ++i)
    list += std::to_string(1000.0 + 0.1 * i) + " image" + std::to_string(i) + ".png\n";
  folder.write("recording/rgb.txt", list);
  folder.write("recording/depth.txt", list);
  RunData run = run_with_pictures(folder);
  run.dataset = folder.path() / "recording";
  choose_pictures(run);
  const auto worst = std::ranges::find(run.pictures, 52U, &Picture::frame);
  ASSERT_NE(worst, run.pictures.end());
  EXPECT_EQ(worst->file, folder.path() / "recording/image52.png");
  EXPECT_EQ(worst->why, "largest error: 42.1 mm");
  EXPECT_TRUE(worst->recorded);
  EXPECT_FALSE(run.pictures.front().recorded);
}

TEST(PageJson, DroppedFramesTakeNoTime) {
  ReportData data;
  data.runs.resize(1);
  data.runs[0].frames = 4;
  data.runs[0].processed_frames = 2;
  StageTimes& stage = data.runs[0].stages.emplace_back();
  stage = {.stage = "track", .calls = 2, .frame = {0, 3}, .wall_ms = {20, 20}, .cpu_ms = {10, 10}};
  stage.cpu.mean = 10;
  const nlohmann::json parts = run_json(data.runs[0], 1)["stages"]["list"][0];
  EXPECT_EQ(parts["cpu_ms"][0], 1000);  // hundredths of a millisecond
  EXPECT_EQ(parts["wall_ms"][0], 2000);
  EXPECT_EQ(report_json(data, "")["runs"][0]["stages"][0][1], 10.0);
}

TEST(PageJson, StagesOfThePipelineHaveTitles) {
  ReportData data;
  data.runs.resize(1);
  for (const char* name : {"prepare", "mine"}) {
    data.runs[0].stages.emplace_back();
    data.runs[0].stages.back().stage = name;
  }
  const nlohmann::json stages = run_json(data.runs[0], 10)["stages"]["list"];
  EXPECT_EQ(stages.at(0)["title"], "Feature extraction");
  EXPECT_EQ(stages.at(1)["title"], "");
  EXPECT_EQ(report_json(data, "")["stage_titles"],
            (nlohmann::json{{"prepare", "Feature extraction"}, {"mine", ""}}));
}

}  // namespace
}  // namespace stillpoint::report
