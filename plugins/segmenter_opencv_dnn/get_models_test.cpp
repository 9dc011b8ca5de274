// tools/get_models installs what has the right checksum, and nothing else.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "segmenter_opencv_dnn/test_networks.hpp"
#include "support/shared_data.hpp"

namespace stillpoint::segmenter_opencv_dnn {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr char kCfg[] = "yolo-fastest-1.1-xl.cfg";
constexpr char kWeights[] = "yolo-fastest-1.1-xl.weights";

class GetModels : public ::testing::Test {
 protected:
  /// Exit status; what it said on standard error is `message_`.
  int get(const std::string& network) {
    const std::string command = "'" STILLPOINT_SOURCE_DIR "/tools/get_models' --from '" +
                                from_.path().string() + "' --to '" + to_.path().string() + "' " +
                                network;
    ::testing::internal::CaptureStderr();
    const int status = std::system(command.c_str());
    message_ = ::testing::internal::GetCapturedStderr();
    return status;
  }
  std::size_t installed() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(to_.path()), fs::directory_iterator()));
  }

  const testing::TemporaryFolder from_, to_;
  std::string message_;
};

TEST_F(GetModels, InstallsWhatIsAsPublished) {
  const fs::path models = testing::shared_data() / "models";
  if (!fs::exists(models / kWeights)) GTEST_SKIP() << "no " << kWeights << " in " << models;
  for (const char* name : {kCfg, kWeights}) fs::copy(models / name, from_.path() / name);
  EXPECT_EQ(get("yolo_fastest"), 0) << message_;
  for (const char* name : {kCfg, kWeights})
    EXPECT_EQ(read_file(to_.path() / name), read_file(models / name));
  EXPECT_EQ(installed(), 2u);
}

TEST_F(GetModels, SaysWhatToDownloadWhatItCannotGet) {
  EXPECT_NE(get("yolo_fastest"), 0);
  EXPECT_THAT(message_, HasSubstr(std::string("could not get ") + kCfg + " " + kWeights));
  EXPECT_THAT(message_, HasSubstr("https://github.com/dog-qiuqiu/Yolo-Fastest/"));
  EXPECT_THAT(message_, HasSubstr("tools/get_models --from FOLDER yolo_fastest"));
  EXPECT_EQ(installed(), 0u);
}

TEST_F(GetModels, RefusesWhatIsDamaged) {
  from_.write(kCfg, "[net]\n");
  EXPECT_NE(get("yolo_fastest"), 0);
  EXPECT_THAT(message_, HasSubstr(std::string(kCfg) + ", from " + kCfg + ", has another checksum"));
  from_.write("deeplabv3_mnv2_pascal_quant.tflite", "this is text");
  EXPECT_NE(get("deeplab_voc21"), 0);
  EXPECT_THAT(message_, HasSubstr("cannot be made of deeplabv3_mnv2_pascal_quant.tflite"));
  EXPECT_EQ(installed(), 0u);
}

TEST_F(GetModels, KnowsItsNetworks) {
  EXPECT_NE(get("yolo"), 0);
  EXPECT_THAT(message_, HasSubstr("no network named 'yolo'; there are: deeplab_voc21"));
}

}  // namespace
}  // namespace stillpoint::segmenter_opencv_dnn
