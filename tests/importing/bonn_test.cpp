#include "importing/fixtures.hpp"

namespace stillpoint::importing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(BonnTest, IsTumWithAKnownCamera) {
  const TemporaryFolder folder;
  const fs::path recording = folder.path() / "rgbd_bonn_balloon";
  {
    stillpoint::testing::RecordingWriter writer(recording);
    for (int i = 0; i < 3; ++i)
      writer.pair(1548266500.5 + 0.1 * i, flat_color(), flat_depth(10000 + i));
  }
  folder.write("rgbd_bonn_balloon/groundtruth.txt", "# ground truth\n" +
                                                        pose_text("1548266500.51", some_pose(0)) +
                                                        pose_text("1548266500.52", some_pose(1)));
  const Imported imported(recording / "");
  ASSERT_EQ(imported.read.pairs.size(), 3u);
  EXPECT_EQ(imported.metres(2, 7, 7), 10002 / 5000.0);
  EXPECT_EQ(imported.camera.name, "bonn");
  EXPECT_EQ(imported.written, 0u);
  ASSERT_EQ(imported.truth().size(), 2u);
  expect_pose(imported.truth()[1].world_from_camera, some_pose(1));
  EXPECT_THAT(imported.notes, ElementsAre(HasSubstr("that of the markers")));
}

}  // namespace
}  // namespace stillpoint::importing
