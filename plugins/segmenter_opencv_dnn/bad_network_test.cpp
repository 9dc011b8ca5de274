// Faults that are known when the segmenter is made: each names the file, the reason and the remedy,
// and OpenCV says nothing on its own.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <functional>
#include <limits>

#include "segmenter_opencv_dnn/test_networks.hpp"

namespace stillpoint::segmenter_opencv_dnn {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using Options = OpenCvDnnSegmenter::Options;

class BadNetwork : public ::testing::Test {
 protected:
  BadNetwork() { options_.network.model = shipped_model(); }

  /// The message of the fault.
  std::string fault(Fault expected) {
    ::testing::internal::CaptureStderr();
    std::string message = "no fault";
    try {
      OpenCvDnnSegmenter(options_, {});
    } catch (const Error& error) {
      EXPECT_EQ(error.fault(), expected) << error.what();
      message = error.what();
    }
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
    return message;
  }

  void use_darknet() {
    options_.network = darknet_network(folder_);
    options_.rule.result = ResultKind::kBoxes;
    options_.classes = {"background", "cat", "dog"};
  }

  testing::TemporaryFolder folder_;
  Options options_;
};

TEST_F(BadNetwork, Missing) {
  options_.network.model = folder_.path() / "missing.onnx";
  EXPECT_THAT(fault(Fault::kUsage), AllOf(HasSubstr("missing.onnx"), HasSubstr("does not exist"),
                                          HasSubstr("stillpoint-get-models")));
}

TEST_F(BadNetwork, PipesAndGigabytesAreNotRead) {
  options_.network.model = folder_.write("net.onnx", "");
  std::filesystem::resize_file(options_.network.model, 20'000'000'000);  // sparse
  EXPECT_THAT(fault(Fault::kData), HasSubstr("such a file has at most 2047"));
  std::filesystem::remove(options_.network.model);
  ASSERT_EQ(::mkfifo(options_.network.model.c_str(), 0600), 0);
  EXPECT_THAT(fault(Fault::kData), HasSubstr("is no regular file"));
}

TEST_F(BadNetwork, TruncatedOnnx) {
  const std::string whole = read_file(shipped_model());
  for (const double part : {0.0, 0.001, 0.5, 0.9999}) {
    options_.network.model = folder_.write(
        "cut.onnx",
        whole.substr(0, static_cast<std::size_t>(part * static_cast<double>(whole.size()))));
    EXPECT_THAT(fault(Fault::kData), AllOf(HasSubstr("cut.onnx"), HasSubstr("truncated")));
  }
}

TEST_F(BadNetwork, TruncatedDarknet) {
  use_darknet();
  const std::string whole = read_file(options_.network.model);
  options_.network.model = folder_.write("cut.weights", whole.substr(0, whole.size() - 8));
  EXPECT_THAT(fault(Fault::kData), AllOf(HasSubstr("cut.weights"), HasSubstr("truncated")));
}

TEST_F(BadNetwork, WeightsThatAreNotNumbers) {
  use_darknet();
  std::string file = read_file(options_.network.model);
  const float not_a_number = std::numeric_limits<float>::quiet_NaN();
  file.replace(file.size() - sizeof(float), sizeof(float), bytes_of({not_a_number}));
  options_.network.model = folder_.write("nan.weights", file);
  EXPECT_THAT(fault(Fault::kData),
              AllOf(HasSubstr("nan.weights"), HasSubstr("not all finite"), HasSubstr("damaged")));
}

TEST_F(BadNetwork, OutputsThatAreNotNumbers) {
  const testing::TemporaryFolder folder;
  Options options;
  options.network = caffe_network(folder, subsampling(1), {4, 4});
  options.network.scale = {1e38};
  options.rule.result = ResultKind::kClassLogits;
  options.classes = {"background", "cat", "dog"};
  OpenCvDnnSegmenter segmenter(options, {});
  Frame frame;
  frame.bgr = cv::Mat(4, 4, CV_8UC3, cv::Scalar::all(200));
  try {
    segmenter.segment(frame);
    FAIL() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kStage);
    EXPECT_THAT(error.what(), HasSubstr("not all finite"));
  }
}

TEST_F(BadNetwork, OfAnotherKind) {
  options_.network.model = folder_.write("notes.txt", "text");
  EXPECT_THAT(fault(Fault::kUsage), HasSubstr(".onnx, .caffemodel"));
  options_.network.model = folder_.write("text.onnx", "this is text");
  EXPECT_THAT(fault(Fault::kData), HasSubstr("cannot be read as an ONNX network"));
  options_.network.model = folder_.write("text.pb", "this is text");
  EXPECT_THAT(fault(Fault::kData), HasSubstr("cannot be read as a TensorFlow network"));
}

TEST_F(BadNetwork, ConfigMissingOrWrong) {
  use_darknet();
  const std::string config = options_.network.config;
  options_.network.config = "";
  EXPECT_THAT(fault(Fault::kUsage), HasSubstr("'config'"));
  options_.network.config = options_.network.model;
  EXPECT_THAT(fault(Fault::kUsage), HasSubstr("does not belong to a Darknet network"));
  options_.network.model = shipped_model();
  options_.network.config = config;
  EXPECT_THAT(fault(Fault::kUsage), HasSubstr("leave 'config' out"));
}

TEST_F(BadNetwork, UnsupportedLayersAreNamed) {
  std::string onnx = read_file(shipped_model());
  for (auto at = onnx.find("\x07Sigmoid"); at != std::string::npos; at = onnx.find("\x07Sigmoid"))
    onnx.replace(at, 8, "\x07Sigmoyd");
  options_.network.model = folder_.write("unknown.onnx", onnx);
  EXPECT_THAT(fault(Fault::kData), HasSubstr("unsupported layer 'Sigmoyd'"));

  options_.network = caffe_network(
      folder_, "layer { name: \"up\" type: \"Upsample\" bottom: \"data\" top: \"up\" }", {8, 8});
  EXPECT_THAT(fault(Fault::kData), HasSubstr("unsupported layer 'Upsample'"));

  use_darknet();
  options_.network.config = folder_.write("unknown.cfg", "[net]\nwidth=8\n\n[gru]\noutput=8\n");
  EXPECT_THAT(fault(Fault::kData), HasSubstr("unsupported layer 'gru'"));
}

TEST_F(BadNetwork, InputOfAnotherSize) {
  options_.network.width = 200;
  EXPECT_THAT(fault(Fault::kData), HasSubstr("black image of 200 x 144"));
}

TEST_F(BadNetwork, OutputUnknownOrAmbiguous) {
  options_.network.output = "ouput0";
  EXPECT_THAT(fault(Fault::kUsage), HasSubstr("did you mean 'output0'?"));
  options_.network = caffe_network(folder_, red_channel(), {4, 4});
  EXPECT_THAT(fault(Fault::kUsage), HasSubstr("several outputs: out, other"));
}

TEST_F(BadNetwork, OutputOfAnotherShape) {
  options_.rule.result = ResultKind::kBoxes;
  EXPECT_THAT(fault(Fault::kUsage), HasSubstr("the output is 1 x 1 x 144 x 256, not N x 6"));
  options_.rule.result = ResultKind::kClassLogits;
  options_.classes = {"voc21"};
  EXPECT_THAT(fault(Fault::kUsage), HasSubstr("not 1 x 21 x height x width"));
  use_darknet();
  options_.classes = {"coco80"};
  EXPECT_THAT(fault(Fault::kUsage), HasSubstr("not N x 85"));
}

TEST_F(BadNetwork, ClassesUnknownOrTooMany) {
  options_.classes = {"persn"};
  EXPECT_THAT(fault(Fault::kUsage), HasSubstr("did you mean 'person'?"));
  options_.classes = {"background", "person", "chair"};
  EXPECT_THAT(fault(Fault::kUsage), HasSubstr("needs two names"));
  options_.classes = {};
  EXPECT_THAT(fault(Fault::kUsage), HasSubstr("'classes' has 0 names"));
}

TEST_F(BadNetwork, CornersThatAreNoCells) {
  options_.network = caffe_network(folder_, subsampling(16), {42, 33});
  options_.rule.result = ResultKind::kClassLogits;
  options_.classes = {"background", "cat", "dog"};
  options_.cells = CellAlignment::kCorners;
  EXPECT_THAT(fault(Fault::kUsage), HasSubstr("input of 42 x 33 pixels"));
}

}  // namespace
}  // namespace stillpoint::segmenter_opencv_dnn
