// What a saved map may hold: files with right checksums and impossible values are refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <boost/crc.hpp>
#include <functional>
#include <string>

#include "map_file_fixture.hpp"
#include "stillpoint/runtime/map_writer.hpp"
#include "stillpoint/runtime/mapping_results.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

TEST_F(MapFile, ImpossibleContentIsRefused) {
  const auto refused_after = [&](const std::string& sql, const std::string& why) {
    save_map(small_map(), file_);
    execute(sql);
    SCOPED_TRACE(sql);
    expect_refused(why);
  };
  refused_after("DELETE FROM camera", "a camera is missing");
  refused_after("UPDATE camera SET fx = 0", "a camera is damaged");
  refused_after("DELETE FROM keyframe WHERE id = 1", "a keyframe is missing");
  refused_after("DELETE FROM landmark WHERE id = 9", "a landmark is missing");
  refused_after("DELETE FROM landmark WHERE id > 9", "a landmark is missing");
  refused_after("UPDATE landmark SET x = 9e999", "a landmark is damaged");
  refused_after("UPDATE landmark SET reference = 77", "a landmark is damaged");
  refused_after("UPDATE keyframe SET descriptors = x'00'", "a keyframe is damaged");
  refused_after("DROP TABLE landmark", "its tables are not those of a map");
}

// With right checksums; which values, says MapValues.
TEST_F(MapFile, ImpossibleValuesAreRefused) {
  const auto refused = [&](const std::string& what, const std::function<void(MapEdit&)>& spoil) {
    MapEdit edit(small_map());
    spoil(edit);
    const SparseMap map = std::move(edit).finish();
    fs::remove(file_);
    write_map(map, file_);
    expect_refused(what + " has impossible values");
    fs::remove(file_);
    try {
      save_map(map, file_);
      ADD_FAILURE() << what;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(),
                  HasSubstr("could not be loaded again: " + what + " has impossible"));
    }
    EXPECT_FALSE(fs::exists(file_));
  };
  refused("a landmark", [](MapEdit& edit) { edit.landmark(0).max_distance = -1; });
  refused("a key frame", [](MapEdit& edit) { edit.keyframe(0).world_from_camera(0, 3) = 1e300; });
  refused("a camera", [](MapEdit& edit) {
    auto camera = std::make_shared<Camera>();
    camera->fx = 1e308;
    edit.keyframe(0).camera = camera;
  });
}

// 2^32 + 640 is 640 for who takes the lower half.
TEST_F(MapFile, NumbersBeyondThoseOfTheProgramAreRefused) {
  save_map(small_map(), file_);
  constexpr double kWidth = 4294967936;
  const Camera camera;
  boost::crc_32_type crc;
  for (const double value :
       {0.0, kWidth, double{480}, camera.fx, camera.fy, camera.cx, camera.cy, camera.depth_noise})
    crc.process_bytes(&value, sizeof value);
  execute("UPDATE camera SET width = 4294967936, crc = " + std::to_string(crc.checksum()));
  expect_refused("a number is out of range");
}

TEST_F(MapFile, AKeyFrameWithoutCameraIsNotSaved) {
  MapEdit edit(small_map());
  edit.keyframe(0).camera = nullptr;
  EXPECT_THROW(save_map(std::move(edit).finish(), file_), Error);
  EXPECT_FALSE(fs::exists(file_));
}

// What check_tracking() and check_refined() accept can be saved and loaded.
TEST_F(MapFile, ValuesAtTheirLimitsComeBack) {
  MapEdit edit(small_map());
  edit.keyframe(0).world_from_camera.linear()(0, 1) += 5e-4;
  edit.keyframe(1).world_from_camera.translation() = Eigen::Vector3d(1e7, 0, 0);
  edit.landmark(0).position_in_world = Eigen::Vector3d(0, -1e7, 0);
  edit.landmark(1).max_distance = 1e7F;
  edit.landmark(2).mean_view.setZero();
  const SparseMap map = std::move(edit).finish();
  EXPECT_NO_THROW(check_refined(map, SparseMap()));
  save_map(map, file_);
  expect_same(map, load_map(file_));
}

TEST_F(MapFile, NothingIsMadeOrReadBesideAFileThatIsLoaded) {
  save_map(small_map(), file_);
  execute("PRAGMA journal_mode = WAL");
  ASSERT_EQ(::mkfifo((file_.string() + "-journal").c_str(), 0600), 0);
  expect_same(small_map(), load_map(file_));
  int files = 0;
  for (const auto& entry : fs::directory_iterator(folder_.path())) files += entry.exists() ? 1 : 0;
  EXPECT_EQ(files, 2);
}

TEST_F(MapFile, NoSqlOfTheFileIsRun) {
  const char* const hidden = "ALTER TABLE landmark RENAME TO hidden; ";
  for (const std::string& sql :
       {hidden + std::string("CREATE VIEW landmark AS SELECT * FROM hidden"),
        hidden +
            std::string("CREATE TABLE landmark (id INTEGER PRIMARY KEY CHECK (id < 1), x AS (id))"),
        std::string("ALTER TABLE camera ADD COLUMN large AS (hex(zeroblob(1000000000)))"),
        std::string("CREATE TRIGGER one AFTER INSERT ON camera BEGIN SELECT 1; END"),
        std::string("CREATE INDEX one ON camera (fx) WHERE fx > 1")}) {
    SCOPED_TRACE(sql);
    save_map(small_map(), file_);
    execute(sql);
    expect_refused("its tables are not those of a map");
  }
  save_map(small_map(), file_);
  for (const char* version : {"-1", "0"}) {
    execute(std::string("PRAGMA user_version = ") + version);
    expect_refused("it has no version");
  }
}

}  // namespace
}  // namespace stillpoint
