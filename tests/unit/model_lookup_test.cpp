#include "stillpoint/support/model_lookup.hpp"

#include <gmock/gmock.h>

#include <cstdlib>

#include "stillpoint/error.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint {
namespace {

using ::testing::HasSubstr;

const int own = 0;

class ModelLookup : public ::testing::Test {
 protected:
  void SetUp() override {
    ::setenv("STILLPOINT_MODEL_PATH",
             (first_.path().string() + ":" + second_.path().string()).c_str(), 1);
    ::setenv("XDG_DATA_HOME", data_.path().c_str(), 1);
  }
  void TearDown() override {
    ::unsetenv("STILLPOINT_MODEL_PATH");
    ::unsetenv("XDG_DATA_HOME");
  }
  testing::TemporaryFolder first_, second_, data_;
};

TEST_F(ModelLookup, TakesTheFileItselfFirst) {
  const auto file = data_.write("here/net.onnx", "");
  first_.write("net.onnx", "");
  EXPECT_EQ(find_model(file, &own), file);
}

TEST_F(ModelLookup, SearchesTheFoldersInOrder) {
  data_.write("stillpoint/models/net.onnx", "");
  EXPECT_EQ(find_model("/configs/net.onnx", &own), data_.path() / "stillpoint/models/net.onnx");
  second_.write("net.onnx", "");
  EXPECT_EQ(find_model("/configs/net.onnx", &own), second_.path() / "net.onnx");
  first_.write("net.onnx", "");
  EXPECT_EQ(find_model("/configs/net.onnx", &own), first_.path() / "net.onnx");
}

TEST_F(ModelLookup, NamesEveryPlaceWhenThereIsNone) {
  try {
    find_model("/configs/net.onnx", &own);
    FAIL() << "found";
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kUsage);
    for (const auto& folder : model_folders(&own))
      EXPECT_THAT(error.what(), HasSubstr((folder / "net.onnx").string()));
    EXPECT_THAT(error.what(), HasSubstr("stillpoint-get-models"));
  }
}

TEST_F(ModelLookup, FoldersAreNoModels) {
  std::filesystem::create_directory(first_.path() / "net.onnx");
  EXPECT_THROW(find_model((first_.path() / "net.onnx").string(), &own), Error);
}

}  // namespace
}  // namespace stillpoint
