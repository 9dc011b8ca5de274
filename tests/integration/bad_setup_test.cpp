// Wrong usage, configuration and plugins that cannot be used, through the program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <string>
#include <vector>

#include "bad_setup_fixture.hpp"
#include "support/full_disk.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

TEST_F(BadSetup, CommandLine) {
  expect_refused(call({}), "Run 'stillpoint --help' for help.");
  expect_refused(call({"simulat", "office"}), "no command 'simulat'; did you mean 'simulate'?");
  expect_refused(call({"run"}), "pipeline is required");
  expect_refused(call({"run", "orb_baseline", "--fast"}), "--fast");
  expect_refused(call({"evaluate", "--json"}), "--reference");
  expect_refused(run("orb_baseline", {}), "no recording is given; name its folder with --dataset");
}

TEST_F(BadSetup, NamesThatDoNotExist) {
  expect_refused(run("orb_baselin", on_recording()), "did you mean 'orb_baseline'?");
  expect_refused(run((folder_.path() / "mine.yaml").string(), on_recording()),
                 "mine.yaml: no such pipeline file");
  expect_refused(run("orb_baseline", on_recording({"--camera", "tum_fr11"})),
                 "no camera named 'tum_fr11'; did you mean 'tum_fr1'?");
  expect_refused(run("orb_baseline", on_recording({"--set", "tracker.type=orbs"})),
                 "no tracker named 'orbs'; did you mean 'orb'?");
}

TEST_F(BadSetup, FaultsOfThePipelineFileAreReportedTogether) {
  const fs::path file = folder_.write("mine.yaml",
                                      "version: 1\n"
                                      "source: {type: tum_rgbd, strid: 2}\n"
                                      "tracker: {type: orb, levels: 99}\n"
                                      "local_mapper: {type: orb}\n"
                                      "local_mapper: {type: orb}\n");
  const Outcome outcome = run(file.string(), on_recording());
  expect_refused(outcome, file.string() + ":2:26: error: source: unknown key 'strid'; did you");
  EXPECT_THAT(outcome.err,
              HasSubstr(file.string() + ":3:30: error: tracker.levels = 99 is outside"));
  EXPECT_THAT(outcome.err,
              HasSubstr(file.string() + ":5:1: error: key 'local_mapper' is given twice"));
  EXPECT_FALSE(fs::exists(out())) << "a run folder, though nothing has run";
}

// A pipe that nobody writes to would be waited for without end.
TEST_F(BadSetup, PipesInPlaceOfFilesAreRefused) {
  const std::string pipe = (folder_.path() / "pipe").string(), out = this->out().string();
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const std::string recording = simulated_recording().string();
  const std::vector<std::vector<std::string>> commands = {
      {"run", pipe, "--dataset", recording, "-o", out},
      {"run", "orb_baseline", "--dataset", recording, "--camera", pipe, "-o", out},
      {"run", "orb_baseline", "--dataset", recording, "--load-map", pipe, "-o", out},
      {"run", "orb_baseline", "--dataset", pipe, "-o", out},
      {"run", "orb_baseline", "--dataset", recording, "--set", "segmenter.type=segnet", "--set",
       "segmenter.prototxt=" + pipe, "--set", "segmenter.model=" + pipe, "-o", out},
      {"run", "stillpoint", "--dataset", recording, "--set", "segmenter.model=" + pipe, "-o", out},
      {"simulate", pipe, "-o", out},
      {"ablate", pipe, "-o", out},
      {"inspect", pipe},
      {"import", pipe, "-o", out},
      {"map", "info", pipe},
      {"evaluate", "--reference", pipe, "--estimate", pipe},
      {"plugins", "check", pipe}};
  for (const std::vector<std::string>& command : commands) {
    const Outcome outcome = call(command);
    SCOPED_TRACE(::testing::PrintToString(command));
    EXPECT_TRUE(outcome.exit_code == 2 || outcome.exit_code == 3) << outcome.signal;
    EXPECT_THAT(outcome.err, HasSubstr("error: "));
    EXPECT_THAT(outcome.err, HasSubstr(pipe));
    EXPECT_FALSE(fs::exists(out + "/trajectory.txt"));
  }
}

TEST_F(BadSetup, UnreadableYaml) {
  const fs::path file = folder_.write("broken.yaml", "version: 1\nsource: {type: tum_rgbd\n");
  expect_refused(run(file.string(), on_recording()), file.string() + ":3:1: error: not valid YAML");
}

// yaml-cpp takes them for one empty document after the other, without end.
TEST_F(BadSetup, TextsThatBeginWithAComma) {
  const fs::path file = folder_.write("comma.yaml", ", a\n");
  expect_refused(run(file.string(), on_recording()), file.string() + ":1:1: error: not valid YAML");
  expect_refused(run("orb_baseline", on_recording({"--set", "tracker.features=, a"})),
                 "not valid YAML: a value is missing");
  expect_refused(run("orb_baseline", on_recording({"--camera", file.string()})),
                 file.string() + ":1:1: error: not valid YAML: a value is missing");
  const Outcome study = call({"ablate", file.string(), "-o", out().string()});
  expect_refused(study, file.string() + ":1:1: error: not valid YAML");
  expect_refused(call({"simulate", file.string(), "-o", out().string()}),
                 file.string() + ":1:1: error: not valid YAML");
  // A recording's own camera.
  const fs::path recording = folder_.path() / "recording";
  fs::copy(simulated_recording(), recording, fs::copy_options::recursive);
  fs::copy_file(file, recording / "camera.yaml", fs::copy_options::overwrite_existing);
  expect_refused(run("orb_baseline", {"--dataset", recording.string()}),
                 (recording / "camera.yaml").string() + ":1:1: error: not valid YAML");
}

TEST_F(BadSetup, KeysThatAreNestedTooDeeply) {
  std::string key = "a";
  for (int i = 0; i < 60'000; ++i) key += ".a";
  expect_refused(run("orb_baseline", on_recording({"--set", key + "=1"})), "nested too deeply");
}

TEST_F(BadSetup, PicturesOutsideTheRunFolder) {
  for (const char* folder : {"/tmp", "..", "a/../..", ".", "''"})
    expect_refused(run("orb_baseline", on_recording({"--with", "images", "--with",
                                                     std::string("images.folder=") + folder})),
                   "folder must be a name below the run folder");
}

TEST_F(BadSetup, RunFolderThatCannotBeWritten) {
  const fs::path file = folder_.write("file", "");
  const Outcome outcome = call({"run", "orb_baseline", "--dataset", simulated_recording().string(),
                                "-o", (file / "out").string()});
  expect_refused(outcome, (file / "out").string() + ": cannot write the run folder: ");
  EXPECT_THAT(outcome.err, HasSubstr("choose another one with -o"));
}

TEST_F(BadSetup, SimulateDoesNotTouchARecording) {
  const RecordingCopy recording(1);
  expect_refused(call({"simulate", kScene, "--frames", "1", "-o", recording.path().string()}),
                 recording.path().string());
  expect_refused(call({"simulate", "fr3_wlking_xyz", "-o", out().string()}),
                 "did you mean 'fr3_walking_xyz'?");
}

TEST_F(BadSetup, SimulateSaysThatTheDiskIsFull) {
  const FullDisk full(512);  // bytes; camera.yaml has more
  expect_refused(call({"simulate", kScene, "--frames", "1", "-o", (out() / "new").string()}),
                 "camera.yaml: cannot write: ");
}

TEST_F(BadPlugins, AreListedWithTheirReasonsBesideTheGoodOnes) {
  const Outcome outcome = call({"plugins", "list"}, with_plugins());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* reason :
       {"libstillpoint_text.so: not a shared library", "libstillpoint_truncated.so: truncated",
        "libstillpoint_no_symbol.so: does not export", "libstillpoint_older_api.so: built for",
        "libstillpoint_newer_api.so: built for", "libstillpoint_wrong_tag.so: built with",
        "libstillpoint_undefined_symbol.so: cannot be loaded: undefined symbol"})
    EXPECT_THAT(outcome.out, HasSubstr(reason));
  for (const char* type : {"tum_rgbd", "simulation", "orb", "trajectory", "good"})
    EXPECT_THAT(outcome.out, ::testing::ContainsRegex(std::string(type) + " +[0-9.]+ +/"));
  const Outcome run_among_them = run("orb_baseline", on_recording(), with_plugins());
  EXPECT_EQ(run_among_them.exit_code, 0) << run_among_them.err;
  EXPECT_EQ(count_poses(out() / "trajectory.txt"), 6u);
}

TEST_F(BadPlugins, AListForProgramsAndForScripts) {
  const Outcome good = call({"plugins", "list", "--strict"});
  EXPECT_EQ(good.exit_code, 0) << good.err;
  Surroundings surroundings = with_plugins();
  surroundings.environment["STILLPOINT_PLUGIN_PATH"] += ":/nowhere";
  const Outcome bad = call({"plugins", "list", "--strict", "--json"}, surroundings);
  EXPECT_EQ(bad.exit_code, 2);
  const auto list = nlohmann::json::parse(bad.out);
  EXPECT_GT(list["types"].size(), 20u);
  EXPECT_TRUE(list["types"][0].contains("library"));
  EXPECT_GT(list["unusable"].size(), 5u);
  EXPECT_EQ(list["missing_folders"], nlohmann::json({"/nowhere"}));
  EXPECT_THAT(call({"plugins", "list"}, surroundings).out,
              HasSubstr("folders that are not there:\n  /nowhere\n"));
}

TEST_F(BadPlugins, ReasonsExplainWhyATypeIsMissing) {
  const Outcome outcome =
      run("orb_baseline", on_recording({"--set", "moving_checker.type=older_api"}), with_plugins());
  expect_refused(outcome, "no moving_checker named 'older_api'");
  EXPECT_THAT(outcome.err, HasSubstr("not usable: libstillpoint_"));
  EXPECT_THAT(outcome.err, HasSubstr("rebuild it against Stillpoint"));
  EXPECT_THAT(outcome.err, HasSubstr("searched:   " + folder_.path().string()));
}

TEST_F(BadPlugins, ThrowingConstructorIsNamed) {
  const Outcome outcome =
      run("orb_baseline", on_recording({"--set", "moving_checker.type=throws_in_constructor"}),
          with_plugins());
  EXPECT_EQ(outcome.exit_code, kStageFailed);
  EXPECT_THAT(outcome.err,
              HasSubstr("error: moving_checker (throws_in_constructor): no such model file"));
}

}  // namespace
}  // namespace stillpoint::testing
