#include "segmenter_segnet/segnet_network.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <opencv2/core/utility.hpp>

#include "segmenter_segnet/caffe_weights.hpp"
#include "segmenter_segnet/test_network.hpp"
#include "segmenter_segnet/test_reference.hpp"
#include "stillpoint/error.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint::segmenter_segnet {
namespace {

using stillpoint::testing::TemporaryFolder;
using ::testing::AllOf;
using ::testing::HasSubstr;

class SegnetNetworkTest : public ::testing::Test {
 protected:
  SegnetNetwork load(const std::string& prototxt, const std::string& model) {
    return {folder_.write("net.prototxt", prototxt), folder_.write("net.caffemodel", model)};
  }
  SegnetNetwork load(const TestNetwork& network) {
    return load(network.prototxt(), network.caffemodel());
  }
  /// Largest difference between our scores and the plain loops'.
  double error_of(TestNetwork& network, ModelFormat format = ModelFormat::kToday) {
    SegnetNetwork loaded = load(network.prototxt(), network.caffemodel(format));
    const cv::Mat image = network.image();
    const cv::Mat scores = loaded.scores(image);
    const Tensor expected = reference_scores(network, image);
    EXPECT_EQ(loaded.channels(), expected.channels);
    EXPECT_EQ(loaded.output_size(), cv::Size(expected.width, expected.height));
    EXPECT_EQ(scores.total(), expected.values.size());
    double error = 0;
    for (std::size_t i = 0; i < std::min(scores.total(), expected.values.size()); ++i)
      error = std::max(error, std::abs(scores.ptr<float>()[i] - expected.values[i]));
    return error;
  }
  std::string message_of(const std::string& prototxt, const std::string& model) {
    try {
      load(prototxt, model);
    } catch (const Error& error) {
      EXPECT_EQ(error.fault(), Fault::kData);
      return error.what();
    }
    return "nothing was thrown";
  }
  std::string message_of(const TestNetwork& network) {
    return message_of(network.prototxt(), network.caffemodel());
  }

  TemporaryFolder folder_;
};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t position = text.find(from);
  EXPECT_NE(position, std::string::npos) << from;
  return position == std::string::npos ? text : text.replace(position, from.size(), to);
}

/// One level, all that a SegNet needs.
TestNetwork tiny(int height = 8, int width = 10, std::uint64_t seed = 1) {
  TestNetwork network(height, width, seed);
  network.convolution("conv1", 4, 3).bn("conv1_bn").relu("relu1").pool("pool1");
  network.upsample("upsample1", "pool1").convolution("conv1_D", 3, 3);
  return network.plain("ArgMax", "argmax", false, "argmax_param { axis: 1 }\n");
}

class SeedTest : public SegnetNetworkTest, public ::testing::WithParamInterface<int> {};
INSTANTIATE_TEST_SUITE_P(Seeds, SeedTest, ::testing::Range(1, 6));

TEST_P(SeedTest, SegnetBasicIsExact) {
  TestNetwork network = segnet_basic(32, 48, 6, 4, static_cast<std::uint64_t>(GetParam()));
  EXPECT_LT(error_of(network), 1e-4);
}

TEST_P(SeedTest, Vgg16IsExact) {
  TestNetwork network = segnet_vgg16(64, 96, 16, 5, static_cast<std::uint64_t>(GetParam()));
  EXPECT_LT(error_of(network), 1e-4);
}

TEST_P(SeedTest, OddSizesAreExact) {  // 45 → 23 → 45, as at 360 x 480
  TestNetwork network = segnet_basic(45, 51, 4, 3, static_cast<std::uint64_t>(GetParam()));
  EXPECT_LT(error_of(network), 1e-4);
}

TEST_P(SeedTest, FirstOfEqualsIsPooled) {
  const auto seed = static_cast<std::uint64_t>(GetParam());
  TestNetwork network(13, 15, seed);
  network.whole_numbers().convolution("conv1", 8, 3).relu("relu1").pool("pool1");
  network.convolution("conv2", 8, 3).pool("pool2");
  network.upsample("upsample2", "pool2").convolution("conv2_D", 8, 1);
  network.upsample("upsample1", "pool1").convolution("conv1_D", 4, 3);
  EXPECT_EQ(error_of(network), 0.0);
}

TEST_F(SegnetNetworkTest, BatchNormAndScaleAreExact) {
  TestNetwork network(17, 20, 3);
  network.convolution("conv1", 8, 3, false).batch_norm("norm1").scale("scale1").relu("relu1");
  network.pool("pool1").upsample("upsample1", "pool1").batch_norm("norm2");
  network.convolution("conv1_D", 6, 3);
  EXPECT_LT(error_of(network), 1e-4);
}

TEST_F(SegnetNetworkTest, WeightsOfV1FilesAreRead) {
  TestNetwork network = tiny();
  EXPECT_LT(error_of(network, ModelFormat::kV1), 1e-4);
}

TEST_F(SegnetNetworkTest, OlderWaysToGiveTheSizeAreUnderstood) {
  for (const std::string parameters :
       {"scale: 2 pad_out_h: true", "scale_h: 2 scale_w: 2 pad_out_h: 1", "pad_out_h: true",
        "upsample_h: 9, upsample_w: 10"}) {
    TestNetwork network(9, 10, 1);
    network.convolution("conv1", 4, 3).pool("pool1").upsample("upsample1", "pool1", parameters);
    network.convolution("conv1_D", 3, 3);
    EXPECT_LT(error_of(network), 1e-4) << parameters;
  }
}

TEST_F(SegnetNetworkTest, InputLayersAndLayersForTrainingAreUnderstood) {
  TestNetwork network = tiny();
  const std::string fields =
      "input: \"data\"\ninput_dim: 1\ninput_dim: 3\ninput_dim: 8\ninput_dim: 10\n";
  const std::string input =
      "layer { name: 'image' type: 'Input' top: 'data' input_param { shape: { dim: [6, 3, 8, 10] } "
      "} }"
      "layer { name: 'loss' type: 'SoftmaxWithLoss' bottom: 'x' top: 'y' include { phase: TRAIN } "
      "}";
  const cv::Mat image = network.image();
  const cv::Mat expected = load(network).scores(image).clone();
  SegnetNetwork other = load(replaced(network.prototxt(), fields, input), network.caffemodel());
  EXPECT_EQ(cv::norm(other.scores(image), expected, cv::NORM_INF), 0.0);
  other = load(replaced(network.prototxt(), fields,
                        "input: 'data' input_shape <dim: 1 dim: 3; dim: 8 dim: 10>"),
               network.caffemodel());
  EXPECT_EQ(cv::norm(other.scores(image), expected, cv::NORM_INF), 0.0);
}

TEST_F(SegnetNetworkTest, ScoresAreTheSameEveryTime) {
  TestNetwork network = segnet_basic(45, 60, 8, 3, 1);
  const cv::Mat image = network.image();
  const Tensor expected = reference_scores(network, image);
  const int threads_before = cv::getNumThreads();
  for (const int threads : {1, 2}) {
    cv::setNumThreads(threads);
    SegnetNetwork loaded = load(network);
    const cv::Mat first = loaded.scores(image).clone();
    EXPECT_EQ(cv::norm(loaded.scores(image), first, cv::NORM_INF), 0.0);
    EXPECT_EQ(cv::norm(load(network).scores(image), first, cv::NORM_INF), 0.0);
    // Another number of threads adds in another order, so only nearly the same.
    for (std::size_t i = 0; i < first.total(); ++i)
      ASSERT_NEAR(first.ptr<float>()[i], expected.values[i], 1e-4);
  }
  cv::setNumThreads(threads_before);
}

TEST_F(SegnetNetworkTest, SegnetBasicRunsAtItsPublishedSize) {
  TestNetwork published = segnet_basic(360, 480, 64, 11, 1);
  SegnetNetwork network = load(published);
  EXPECT_EQ(network.input_size(), cv::Size(480, 360));
  EXPECT_EQ(network.output_size(), cv::Size(480, 360));
  const cv::Mat scores = network.scores(published.image());
  EXPECT_EQ(shape_of(scores), (std::vector<int>{1, 11, 360, 480}));
  EXPECT_TRUE(cv::checkRange(scores.reshape(1, 11 * 360)));
}

TEST_F(SegnetNetworkTest, Vgg16FitsThePaperSize) {
  const SegnetNetwork network = load(segnet_vgg16(360, 480, 4, 21, 1));
  EXPECT_EQ(network.output_size(), cv::Size(480, 360));
  EXPECT_EQ(network.channels(), 21);
}

TEST_F(SegnetNetworkTest, MissingFilesAreNamed) {
  const TestNetwork network = tiny();
  const auto prototxt = folder_.write("net.prototxt", network.prototxt());
  const auto model = folder_.write("net.caffemodel", network.caffemodel());
  const auto message = [](const auto& text_file, const auto& model_file) -> std::string {
    try {
      SegnetNetwork(text_file, model_file);
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_THAT(message(folder_.path() / "no.prototxt", model),
              AllOf(HasSubstr("no.prototxt"), HasSubstr("no such file")));
  EXPECT_THAT(message(prototxt, folder_.path() / "no.caffemodel"),
              AllOf(HasSubstr("no.caffemodel"), HasSubstr("no such file")));
  EXPECT_THAT(message(folder_.path(), model), HasSubstr("is no regular file"));
  EXPECT_THAT(message(prototxt, folder_.path()), HasSubstr("is no regular file"));
}

TEST_F(SegnetNetworkTest, SwappedFilesAreToldFromDamagedOnes) {
  const TestNetwork network = tiny();
  EXPECT_THAT(message_of(network.caffemodel(), network.prototxt()), HasSubstr("swapped"));
  EXPECT_THAT(message_of(network.prototxt(), network.prototxt()),
              AllOf(HasSubstr("not a complete .caffemodel"), HasSubstr("net.caffemodel")));
  EXPECT_THAT(message_of(network.prototxt(), ""), HasSubstr("holds no layer with weights"));
  EXPECT_THAT(message_of("", network.caffemodel()), HasSubstr("defines no layers"));
}

TEST_F(SegnetNetworkTest, TruncatedFilesAreRefusedWhereverTheyEnd) {
  const TestNetwork network = tiny();
  const std::string model = network.caffemodel(), prototxt = network.prototxt();
  for (std::size_t size = 0; size < model.size(); size += 37)
    EXPECT_THAT(message_of(prototxt, model.substr(0, size)),
                ::testing::AnyOf(HasSubstr("not a complete .caffemodel"), HasSubstr("no weights")))
        << size;
  for (std::size_t size = 0; size < prototxt.find("conv1_D"); size += 11)
    EXPECT_NE(message_of(prototxt.substr(0, size), model), "") << size;
}

TEST_F(SegnetNetworkTest, DamagedModelsNeverCrash) {
  const TestNetwork network = tiny();
  cv::RNG random(5);
  for (int i = 0; i < 300; ++i) {
    std::string model = network.caffemodel();
    for (int k = 0; k < 5; ++k)
      model[static_cast<std::size_t>(random.uniform(0, static_cast<int>(model.size())))] =
          static_cast<char>(random.uniform(0, 256));
    EXPECT_FALSE(message_of(network.prototxt(), model).empty());
  }
}

TEST_F(SegnetNetworkTest, WeightsThatDoNotFitAreNamed) {
  TestNetwork network = tiny();
  network.layer("conv1_D").blobs.clear();
  EXPECT_THAT(message_of(network),
              AllOf(HasSubstr("layer 'conv1_D'"), HasSubstr("has no weights in the model file")));

  network = tiny();
  network.layer("conv1_bn").blobs.pop_back();
  EXPECT_THAT(message_of(network), AllOf(HasSubstr("layer 'conv1_bn'"), HasSubstr("1 blobs"),
                                         HasSubstr("2 are needed")));

  network = tiny();
  EXPECT_THAT(message_of(replaced(network.prototxt(), "num_output: 4", "num_output: 5"),
                         network.caffemodel()),
              AllOf(HasSubstr("layer 'conv1'"), HasSubstr("needs weights of 5 x 3 x 3 x 3"),
                    HasSubstr("has 4 x 3 x 3 x 3")));

  network.layer("conv1_bn").blobs[0] = {{7}, std::vector<float>(7, 1.0f)};
  EXPECT_THAT(message_of(network), AllOf(HasSubstr("layer 'conv1_bn'"),
                                         HasSubstr("needs weights of 4"), HasSubstr("has 1 x 7")));

  network = tiny();
  network.layer("conv1").blobs[0].shape = {4, 3, 3, 4};
  EXPECT_THAT(message_of(network), AllOf(HasSubstr("layer 'conv1'"), HasSubstr("108 values"),
                                         HasSubstr("4 x 3 x 3 x 4")));

  network = tiny();
  network.layer("conv1_D").blobs[1].values[0] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(message_of(network), AllOf(HasSubstr("layer 'conv1_D'"), HasSubstr("not finite")));
}

TEST_F(SegnetNetworkTest, UnknownLayersAreNamedWithTheirLine) {
  const TestNetwork network = tiny();
  EXPECT_THAT(
      message_of(replaced(network.prototxt(), "\"Upsample\"", "\"Upsampel\""),
                 network.caffemodel()),
      AllOf(HasSubstr("net.prototxt:"), HasSubstr("layer 'upsample1'"),
            HasSubstr("unsupported type 'Upsampel'"), HasSubstr("did you mean 'Upsample'?")));
  EXPECT_THAT(
      message_of(replaced(network.prototxt(), "\"pool1_mask\"\n  pooling", "\"mask\"\n  pooling"),
                 network.caffemodel()),
      AllOf(HasSubstr("layer 'upsample1'"), HasSubstr("reads 'pool1_mask'")));
}

TEST_F(SegnetNetworkTest, NetworksForTrainingAreToldFromThoseForInference) {
  const TestNetwork network = tiny();
  EXPECT_THAT(
      message_of(replaced(network.prototxt(), "bn_mode: INFERENCE", ""), network.caffemodel()),
      AllOf(HasSubstr("layer 'conv1_bn'"), HasSubstr("mode for training")));
  EXPECT_THAT(message_of(replaced(network.prototxt(), "input: \"data\"", ""), network.caffemodel()),
              HasSubstr("has no input"));
  EXPECT_THAT(message_of("layers { name: 'x' type: CONVOLUTION }", network.caffemodel()),
              HasSubstr("V1"));
}

TEST_F(SegnetNetworkTest, UpsamplingToAnotherSizeThanWasPooledIsRefused) {
  TestNetwork network(9, 10, 1);
  network.convolution("conv1", 4, 3).pool("pool1").upsample("upsample1", "pool1", "scale: 2");
  EXPECT_THAT(message_of(network),
              AllOf(HasSubstr("layer 'upsample1'"), HasSubstr("1 x 4 x 10 x 10"),
                    HasSubstr("set upsample_h: 9 and upsample_w: 10")));
}

TEST_F(SegnetNetworkTest, ParametersThatMakeNoSenseAreRefused) {
  const TestNetwork network = tiny();
  const auto message = [&](const std::string& from, const std::string& to) {
    return message_of(replaced(network.prototxt(), from, to), network.caffemodel());
  };
  EXPECT_THAT(message("num_output: 4", "num_output: four"), HasSubstr("must be an integer"));
  EXPECT_THAT(message("kernel_size: 3", "kernel_size: 0"), HasSubstr("has no kernel size"));
  EXPECT_THAT(message("input_dim: 8", "input_dim: 0"), HasSubstr("the input must be"));
  EXPECT_THAT(message("input_dim: 8", "input_dim: 1000000"), HasSubstr("the input must be"));
  EXPECT_THAT(message("pad: 1", "pad: -7"), HasSubstr("layer 'conv1'"));
  EXPECT_THAT(message("stride: 2", "stride: 0"), HasSubstr("layer 'pool1'"));
  EXPECT_THAT(message("pool: MAX", "pool: AVE"), HasSubstr("which only pooling by MAX can"));
  EXPECT_THAT(message("  name: \"relu1\"", "  name: \"conv1\""), HasSubstr("layer 'conv1'"));
}

TEST_F(SegnetNetworkTest, ValuesThatAreNotFiniteEndTheRunCleanly) {
  TestNetwork network(8, 8, 1);
  network.convolution("conv1", 4, 3).pool("pool1").upsample("upsample1", "pool1");
  SegnetNetwork loaded = load(network);
  cv::Mat image = network.image();
  image.setTo(std::numeric_limits<float>::quiet_NaN());
  EXPECT_THROW(loaded.scores(image), Error);
}

}  // namespace
}  // namespace stillpoint::segmenter_segnet
