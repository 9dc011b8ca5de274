// What is given as a bag, and is none that can be read as it is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/core.hpp>
#include <string>

#include "support/bag_writer.hpp"
#include "support/program.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr int kUnusableData = 3;

Outcome run(const fs::path& dataset, const fs::path& out) {
  return call({"run", "orb_baseline", "--dataset", dataset.string(), "-o", out.string()});
}

void write_images(const fs::path& file) {
  const auto writer = make_bag_writer(file, {"mcap", "zstd"});
  const auto kind = writer->serialisation();
  for (std::int64_t time = 1'000'000'000; time < 3'000'000'000; time += 100'000'000) {
    writer->add("/color/image", "sensor_msgs/Image", time,
                image_message(kind, time, "c", cv::Mat(48, 64, CV_8UC3, {90, 90, 90}), "rgb8"));
    writer->add("/depth/image", "sensor_msgs/Image", time,
                image_message(kind, time, "c", cv::Mat(48, 64, CV_16UC1, {2000}), "16UC1"));
  }
  writer->finish();
}

// As `ros2 bag record --compression-mode file` leaves it.
TEST(NamedBag, CompressedAsAWholeIsTold) {
  const TemporaryFolder folder;
  const fs::path file = folder.write("walk/walk_0.mcap.zstd", "\x28\xb5\x2f\xfd....");
  folder.write("walk/metadata.yaml", "rosbag2_bagfile_information: {}\n");
  for (const fs::path& name : {file, file.parent_path(), file.parent_path() / "metadata.yaml"})
    for (const Outcome& outcome :
         {run(name, folder.path() / "out"), call({"inspect", name.string()})}) {
      EXPECT_EQ(outcome.exit_code, kUnusableData) << outcome.err;
      EXPECT_THAT(outcome.err, AllOf(HasSubstr("walk_0.mcap.zstd: is compressed as a whole"),
                                     HasSubstr("decompress it with 'zstd -d' first")));
    }
}

TEST(NamedBag, ByItsMetadataIsItsFolder) {
  const TemporaryFolder folder;
  const fs::path metadata = folder.write("walk/metadata.yaml", "rosbag2_bagfile_information: {}\n");
  folder.write("walk/camera.yaml",
               "camera: {name: mine, width: 64, height: 48, fx: 50, fy: 50, cx: 31.5, cy: 23.5, "
               "depth_factor: 1000}\n");
  write_images(folder.path() / "walk/walk_0.mcap");
  const Outcome inspected = call({"inspect", metadata.string()});
  EXPECT_EQ(inspected.exit_code, 0) << inspected.err;
  EXPECT_THAT(inspected.out,
              AllOf(HasSubstr("MCAP"), HasSubstr("20 images"), HasSubstr("mine: 64 x 48")));
  const Outcome checked =
      call({"check", "orb_baseline", "--dataset", metadata.string(), "--print"});
  EXPECT_EQ(checked.exit_code, 0) << checked.err;
  EXPECT_THAT(checked.out, AllOf(HasSubstr("type: bag"), HasSubstr("name: mine")));
}

}  // namespace
}  // namespace stillpoint::testing
