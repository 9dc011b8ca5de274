#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "fake_stages.hpp"
#include "stillpoint/engine/pipeline_config.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

class PipelineConfigTest : public testing::Test {
 protected:
  PipelineConfigTest() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) / (std::string("stillpoint_config_") + info->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "sub");
    fs::current_path(folder_);
    registry_.add(kFakePlugin);
  }
  ~PipelineConfigTest() override {
    fs::current_path("/");
    fs::remove_all(folder_);
  }

  static void write(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }

  PipelineConfig load(PipelineRequest request) {
    request.plugin_folders = {};
    return load_pipeline(request, registry_);
  }

  std::string source_path(const PipelineConfig& config) {
    return config.source->create<Source>({})->ground_truth();
  }

  fs::path folder_;
  Registry registry_;
};

constexpr const char* kSource = "version: 1\nsource: {type: tum_rgbd, path: data}\n";
constexpr const char* kCamera = "camera: {fx: 100, fy: 100, cx: 50, cy: 50, depth_factor: 5000}\n";

TEST_F(PipelineConfigTest, LeftOutSectionsAreEmpty) {
  write("p.yaml", kSource);
  const PipelineConfig config = load({.pipeline = "p.yaml"});
  EXPECT_FALSE(config.camera || config.segmenter || config.tracker || config.map_backend);
  EXPECT_TRUE(config.outputs.empty());
  EXPECT_EQ(config.runtime.mode, RuntimeOptions::Mode::kThreaded);
}

TEST_F(PipelineConfigTest, ASectionCanBeAFileOfItsOwn) {
  write("p.yaml", std::string(kSource) + "segmenter: sub/net.yaml\ncamera: sub/c.yaml\n");
  write("sub/net.yaml", "version: 1\nsegmenter: {type: opencv_dnn, model: a.onnx, scale: 2}\n");
  write("sub/c.yaml", std::string("version: 1\n") + kCamera);
  const PipelineConfig config = load({.pipeline = "p.yaml"});
  ASSERT_TRUE(config.segmenter && config.camera);
  EXPECT_EQ(config.camera->fx, 100);
  EXPECT_EQ(config.segmenter->create<Segmenter>({})->classes()[1], folder_ / "sub/a.onnx");
}

TEST_F(PipelineConfigTest, ASectionFromAFileReplacesTheOneBelow) {
  write("base.yaml", std::string(kSource) + "segmenter: {type: opencv_dnn, scale: 3}\n");
  write("p.yaml", "extends: base.yaml\nsegmenter: net.yaml\n");
  write("net.yaml", "segmenter: {type: opencv_dnn, model: a.onnx}\n");
  EXPECT_THAT(load({.pipeline = "p.yaml"}).effective_yaml, HasSubstr("scale: 1"));
  const PipelineConfig set =
      load({.pipeline = "base.yaml", .assignments = {"segmenter=net.yaml", "segmenter.scale=5"}});
  EXPECT_THAT(set.effective_yaml, HasSubstr("a.onnx"));
  EXPECT_THAT(set.effective_yaml, HasSubstr("scale: 5"));
}

TEST_F(PipelineConfigTest, ASectionFromAFileThatIsNotThere) {
  write("p.yaml", std::string(kSource) + "segmenter: nte\ncamera: sub\n");
  try {
    load({.pipeline = "p.yaml"});
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("p.yaml:3:12: error: segmenter: no segmenter named 'nte'"));
    EXPECT_THAT(error.what(), HasSubstr("p.yaml:4:9: error: camera: no camera named 'sub'"));
  }
}

TEST_F(PipelineConfigTest, WhatHappensWhenTheSegmenterFails) {
  write("p.yaml", std::string(kSource) + "segmenter: {type: opencv_dnn, on_failure: continue}\n");
  const PipelineConfig config = load({.pipeline = "p.yaml"});
  EXPECT_EQ(config.segmentation.on_failure, SegmentationOptions::OnFailure::kContinue);
  EXPECT_THAT(config.effective_yaml, HasSubstr("on_failure: continue"));
  EXPECT_THROW(load({.pipeline = "p.yaml", .assignments = {"segmenter.on_failure=stopp"}}),
               ConfigError);
}

TEST_F(PipelineConfigTest, EffectiveFileLoadsToItself) {
  write("p.yaml", std::string(kSource) + kCamera +
                      "moving_checker: {type: lk_usac, epsilon: 0.1}\ndecision: {type: "
                      "object_vote, rule: most}\noutputs: [{type: trajectory}, {type: "
                      "trajectory, format: kitti}]\nruntime: {mode: inline, seed: 7}\n");
  const std::string first = load({.pipeline = "p.yaml"}).effective_yaml;
  EXPECT_THAT(first, HasSubstr("epsilon: 0.1  # farther than this is moving [px]; default 1"));
  write("sub/q.yaml", first);
  EXPECT_EQ(load({.pipeline = "sub/q.yaml"}).effective_yaml, first);
}

TEST_F(PipelineConfigTest, PathsBelongToTheFileThatNamesThem) {
  write("sub/parent.yaml", kSource);
  write("child.yaml", "extends: sub/parent.yaml\n");
  EXPECT_EQ(source_path(load({.pipeline = "child.yaml"})), folder_ / "sub/data");
  EXPECT_EQ(source_path(load({.pipeline = "child.yaml", .assignments = {"source.path=x/../y"}})),
            folder_ / "y");
  EXPECT_EQ(source_path(load({.pipeline = "child.yaml", .dataset = "sub"})), folder_ / "sub");
  EXPECT_EQ(load({.pipeline = "child.yaml"}).recording, folder_ / "sub/data");
  EXPECT_EQ(load({.pipeline = "child.yaml", .dataset = "sub"}).recording, folder_ / "sub");
}

TEST_F(PipelineConfigTest, AParentHasAPathOrAName) {
  setenv("STILLPOINT_CONFIG_PATH", "shipped", 1);
  fs::create_directories("shipped/pipelines");
  write("shipped/pipelines/known.yaml", kSource);
  write("shipped/pipelines/base.yaml", kSource);
  write("base.yaml", "version: 1\nsource: {type: tum_rgbd, path: mine}\n");
  write("by_name.yaml", "extends: known\n");
  EXPECT_EQ(source_path(load({.pipeline = "by_name.yaml"})), folder_ / "shipped/pipelines/data");
  write("by_path.yaml", "extends: base.yaml\n");
  EXPECT_EQ(source_path(load({.pipeline = "by_path.yaml"})), folder_ / "mine");
  write("unknown.yaml", "extends: knwon\n");
  try {
    load({.pipeline = "unknown.yaml"});
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("unknown.yaml:1:10: error: extends: no pipeline named "
                                        "'knwon'; did you mean 'known'?"));
  }
  unsetenv("STILLPOINT_CONFIG_PATH");
}

TEST_F(PipelineConfigTest, SizeDepthAndNumberOfFilesHaveLimits) {
  const auto message = [this](const std::string& file) -> std::string {
    try {
      load({.pipeline = file});
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "no error";
  };
  write("large.yaml", kSource + std::string(2 << 20, '#'));
  EXPECT_THAT(message("large.yaml"), HasSubstr("large.yaml:1:1: error: is larger than 1 MiB"));
  write("deep.yaml", "a: " + std::string(100'000, '['));
  EXPECT_THAT(message("deep.yaml"), HasSubstr("nested too deeply or too large"));
  for (int i = 0; i < 40; ++i)
    write("chain" + std::to_string(i) + ".yaml",
          "extends: chain" + std::to_string(i + 1) + ".yaml\n");
  write("chain40.yaml", kSource);
  EXPECT_THAT(message("chain0.yaml"), HasSubstr("extends goes on over more than 32 files"));
  EXPECT_EQ(message("chain9.yaml"), "no error");
}

TEST_F(PipelineConfigTest, OverriddenVariablesNeedNotBeSet) {
  unsetenv("STILLPOINT_TEST_UNSET");
  write("p.yaml", "version: 1\nsource: {type: tum_rgbd, path: '${STILLPOINT_TEST_UNSET}/x'}\n");
  EXPECT_THROW(load({.pipeline = "p.yaml"}), ConfigError);
  EXPECT_NO_THROW(load({.pipeline = "p.yaml", .dataset = "."}));
  setenv("STILLPOINT_TEST_UNSET", "/data", 1);
  EXPECT_EQ(source_path(load({.pipeline = "p.yaml"})), "/data/x");
  unsetenv("STILLPOINT_TEST_UNSET");
}

TEST_F(PipelineConfigTest, MapsMergeAndAnotherTypeReplaces) {
  write("parent.yaml", std::string(kSource) +
                           "moving_checker: {type: lk_epipolar, epsilon: 2, max_corners: 50}\n");
  write("child.yaml", "extends: parent.yaml\nmoving_checker: {epsilon: 3}\n");
  const std::string merged = load({.pipeline = "child.yaml"}).effective_yaml;
  EXPECT_THAT(merged, HasSubstr("epsilon: 3 "));
  EXPECT_THAT(merged, HasSubstr("max_corners: 50 "));
  const std::string replaced =
      load({.pipeline = "child.yaml", .assignments = {"moving_checker.type=lk_usac"}})
          .effective_yaml;
  EXPECT_THAT(replaced, HasSubstr("epsilon: 1 "));
  EXPECT_THAT(replaced, HasSubstr("max_corners: 1000 "));
}

TEST_F(PipelineConfigTest, NullRemovesAnInheritedSection) {
  write("parent.yaml", std::string(kSource) + "moving_checker: {type: lk_epipolar}\n");
  write("child.yaml", "extends: parent.yaml\nmoving_checker: null\n");
  EXPECT_FALSE(load({.pipeline = "child.yaml"}).moving_checker);
  EXPECT_FALSE(
      load({.pipeline = "parent.yaml", .assignments = {"moving_checker=null"}}).moving_checker);
}

TEST_F(PipelineConfigTest, CameraPrecedence) {
  fs::create_directories("data");
  write("plain.yaml", kSource);
  write("named.yaml", std::string(kSource) + kCamera);
  write("data/camera.yaml", "camera: {fx: 200, fy: 200, cx: 50, cy: 50, depth_factor: 5000}\n");
  write("other.yaml",
        "version: 1\ncamera: {fx: 300, fy: 300, cx: 50, cy: 50, depth_factor: 5000}\n");
  EXPECT_EQ(load({.pipeline = "plain.yaml"}).camera->fx, 200);
  EXPECT_EQ(load({.pipeline = "named.yaml"}).camera->fx, 100);
  EXPECT_EQ(load({.pipeline = "named.yaml", .camera = "other.yaml"}).camera->fx, 300);
  EXPECT_EQ(load({.pipeline = "plain.yaml", .assignments = {"camera.fx=400"}}).camera->fx, 400);
  write("elsewhere.yaml", "version: 1\nsource: {type: tum_rgbd, path: nowhere}\n");
  EXPECT_FALSE(load({.pipeline = "elsewhere.yaml"}).camera);
  EXPECT_EQ(load({.pipeline = "elsewhere.yaml", .dataset = "data"}).camera->fx, 200);
}

TEST_F(PipelineConfigTest, TheDatasetChoosesBetweenRecordingsAndBags) {
  fs::create_directories("recording");
  fs::create_directories("split");
  write("recording/rgb.txt", "");
  write("split/part_0.mcap", "");
  write("folder.yaml", "version: 1\nsource: {type: tum_rgbd, path: data, max_difference: 0.5}\n");
  write("bag.yaml", "version: 1\nsource: {type: bag, path: data.bag}\n");
  write("own.yaml", "version: 1\nsource: {type: own, path: data}\n");
  const auto type_of = [&](const char* pipeline, const char* dataset) {
    return load({.pipeline = pipeline, .dataset = dataset}).source->type();
  };
  for (const char* bag : {"a.bag", "a.mcap", "a.db3", "a.bag.active", "split"}) {
    EXPECT_EQ(type_of("folder.yaml", bag), "bag") << bag;
    EXPECT_EQ(type_of("bag.yaml", bag), "bag") << bag;
    EXPECT_EQ(type_of("own.yaml", bag), "own") << bag;
  }
  EXPECT_EQ(type_of("folder.yaml", "recording"), "tum_rgbd");
  EXPECT_EQ(type_of("bag.yaml", "recording"), "tum_rgbd");
  const PipelineConfig config = load({.pipeline = "folder.yaml",
                                      .dataset = "a.bag",
                                      .assignments = {"source.max_difference=0.1"}});
  EXPECT_EQ(config.recording, fs::absolute("a.bag"));
}

TEST_F(PipelineConfigTest, NamesAreFoundInTheConfigFolders) {
  fs::create_directories("configs/pipelines");
  fs::create_directories("configs/cameras");
  write("configs/pipelines/base.yaml", kSource);
  write("configs/cameras/kinect.yaml", kCamera);
  setenv("STILLPOINT_CONFIG_PATH", "configs", 1);
  EXPECT_EQ(load({.pipeline = "base", .camera = "kinect"}).camera->fx, 100);
  EXPECT_EQ(load_camera("kinect").fx, 100);
  EXPECT_THROW(load({.pipeline = "bse"}), Error);
  unsetenv("STILLPOINT_CONFIG_PATH");
}

TEST_F(PipelineConfigTest, OutputsSayWhatHappensWhenTheyAreTooSlow) {
  write("p.yaml", std::string(kSource) +
                      "outputs: [{type: trajectory}, {type: trajectory, when_full: drop}, "
                      "{type: trajectory, when_full: wait}]\n");
  const PipelineConfig config = load({.pipeline = "p.yaml"});
  EXPECT_EQ(config.outputs[0].options.when_full, WhenFull::kAuto);
  EXPECT_EQ(config.outputs[1].options.when_full, WhenFull::kDrop);
  EXPECT_EQ(config.outputs[2].options.when_full, WhenFull::kWait);
}

TEST_F(PipelineConfigTest, CameraFilesAreWrittenAndRead) {
  CameraModel camera;
  camera.name = "made";
  camera.fx = 123.456;
  camera.distortion = {0.1, -0.2, 0.001, 0};
  write("camera.yaml", camera_yaml(camera));
  const CameraModel read = load_camera("camera.yaml");
  EXPECT_EQ(read.name, "made");
  EXPECT_EQ(read.fx, 123.456);
  EXPECT_EQ(read.distortion, camera.distortion);
}

TEST_F(PipelineConfigTest, ACameraWithoutTheUnitOfItsDepthIsWarnedOf) {
  write("c.yaml", "camera: {fx: 100, fy: 100, cx: 50, cy: 50}\n");
  write("p.yaml", std::string(kSource) + "camera: c.yaml\n");
  const auto says_so = ::testing::ElementsAre(::testing::HasSubstr("no depth_factor: 5000"));
  EXPECT_THAT(load({.pipeline = "p.yaml"}).warnings, says_so);
  std::vector<std::string> warnings;
  EXPECT_EQ(load_camera("c.yaml", &warnings).depth_factor, 5000);
  EXPECT_THAT(warnings, says_so);
  write("p.yaml", std::string(kSource) + kCamera);
  EXPECT_TRUE(load({.pipeline = "p.yaml"}).warnings.empty());
}

TEST_F(PipelineConfigTest, ConstructorFailuresNameTheStage) {
  write("p.yaml", std::string(kSource) + "outputs: [{type: trajectory}]\n");
  const PipelineConfig config = load({.pipeline = "p.yaml"});
  try {
    config.outputs[0].stage.create<Output>({});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kStage);
    EXPECT_STREQ(error.what(), "output (trajectory): the disk is full");
  }
  EXPECT_THROW(config.source->create<Output>({}), Error) << "another contract";
}

TEST_F(PipelineConfigTest, DamagedFilesAreFaultsNotCrashes) {
  std::string text = std::string(kSource) + kCamera + "moving_checker: {type: lk_usac}\n";
  for (std::size_t i = 0; i < text.size(); ++i) {
    for (const char c : {'\0', '\xff', '{', '*', '&', '"'}) {
      std::string damaged = text;
      damaged[i] = c;
      write("p.yaml", damaged);
      try {
        load({.pipeline = "p.yaml"});
      } catch (const Error& error) {
        EXPECT_EQ(error.fault(), Fault::kUsage);
      }
    }
  }
  write("p.yaml", std::string(100000, '['));
  EXPECT_THROW(load({.pipeline = "p.yaml"}), ConfigError);
}

TEST_F(PipelineConfigTest, WhatIsTooLargeIsSaidOnce) {
  std::string text = std::string(kSource) + kCamera + "tracker:\n";
  for (int i = 0; i < 50'000; ++i) text += "  key_" + std::to_string(i) + ": 1\n";
  write("p.yaml", text);
  try {
    load({.pipeline = "p.yaml"});
    FAIL() << "loaded";
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("too large for a configuration"));
    EXPECT_THAT(error.what(), Not(HasSubstr("unknown key")));
  }
}

}  // namespace
}  // namespace stillpoint
