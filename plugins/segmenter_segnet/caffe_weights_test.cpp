#include "segmenter_segnet/caffe_weights.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "segmenter_segnet/test_network.hpp"
#include "stillpoint/error.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint::segmenter_segnet {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class CaffeWeightsTest : public ::testing::Test {
 protected:
  /// A file with one layer, 'conv', that has this one blob.
  CaffeWeights read(const MessageWriter& blob) {
    return read_bytes(MessageWriter()
                          .bytes(100, MessageWriter()
                                          .bytes(1, "conv")
                                          .bytes(2, "Convolution")
                                          .bytes(7, blob.text())
                                          .text())
                          .text());
  }
  CaffeWeights read_bytes(const std::string& bytes) {
    return read_caffe_weights(folder_.write("net.caffemodel", bytes));
  }
  std::string message_of(const MessageWriter& blob) {
    try {
      read(blob);
    } catch (const Error& error) {
      return error.what();
    }
    return "nothing was thrown";
  }
  static std::string shape(const std::vector<int>& sizes) {
    return MessageWriter().packed_varints(1, sizes).text();
  }

  stillpoint::testing::TemporaryFolder folder_;
};

TEST_F(CaffeWeightsTest, BlobsHaveTheirShapeAndValues) {
  const CaffeWeights weights =
      read(MessageWriter().packed_floats(5, {1, 2, 3, 4, 5, 6}).bytes(7, shape({1, 2, 3, 1})));
  ASSERT_EQ(weights.size(), 1u);
  ASSERT_EQ(weights.at("conv").size(), 1u);
  const cv::Mat& blob = weights.at("conv")[0];
  EXPECT_EQ(shape_text(shape_of(blob)), "1 x 2 x 3 x 1");
  EXPECT_EQ(blob.at<float>(cv::Vec4i(0, 1, 2, 0)), 6.0f);
}

TEST_F(CaffeWeightsTest, ValuesMayBeUnpackedOrDouble) {
  const MessageWriter unpacked =
      MessageWriter().single_float(5, 1.5f).single_float(5, -2).bytes(7, shape({2}));
  EXPECT_EQ(read(unpacked).at("conv")[0].at<float>(1), -2.0f);
  const double values[] = {0.25, 3.0};
  const MessageWriter doubles =
      MessageWriter()
          .bytes(8, {reinterpret_cast<const char*>(values), sizeof values})
          .bytes(7, MessageWriter().varint(1, 2).text());
  EXPECT_EQ(read(doubles).at("conv")[0].at<float>(1), 3.0f);
}

TEST_F(CaffeWeightsTest, ShapesThatDoNotFitTheValuesAreRefused) {
  EXPECT_THAT(message_of(MessageWriter().packed_floats(5, {1, 2}).bytes(7, shape({3}))),
              AllOf(HasSubstr("layer 'conv'"), HasSubstr("2 values"), HasSubstr("is 3")));
  EXPECT_THAT(message_of(MessageWriter().bytes(7, shape({0}))), HasSubstr("0 values"));
  EXPECT_THAT(message_of(MessageWriter().packed_floats(5, {1}).bytes(
                  7, shape({2147483647, 2147483647, 2147483647}))),
              HasSubstr("1 values"));
  EXPECT_THAT(message_of(MessageWriter().packed_floats(5, {1}).varint(1, 1ull << 40)),
              HasSubstr("impossible dimension"));
}

TEST_F(CaffeWeightsTest, OtherFilesAreRefused) {
  for (const std::string& bytes :
       {std::string(), std::string("version https://git-lfs.github.com/spec/v1"),
        std::string("<!DOCTYPE html><html></html>"), std::string(1000, '\xff'),
        std::string(1000, '\0')})
    EXPECT_THROW(read_bytes(bytes), Error) << bytes.substr(0, 20);
}

}  // namespace
}  // namespace stillpoint::segmenter_segnet
