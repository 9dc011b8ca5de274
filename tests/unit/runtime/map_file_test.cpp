#include "stillpoint/engine/map_file.hpp"

#include <gmock/gmock.h>
#include <sqlite3.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <functional>
#include <random>

#include "stillpoint/error.hpp"
#include "stillpoint/runtime/map_writer.hpp"
#include "stillpoint/runtime/mapping_results.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

// Key frames that share landmarks, one of them removed, some landmarks gone.
SparseMap small_map(int keyframes = 6, std::uint64_t seed = 4) {
  constexpr std::uint32_t kFeatures = 40;
  std::mt19937_64 random(seed);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<>(low, high)(random);
  };
  const auto camera = std::make_shared<const Camera>();
  MapEdit edit{SparseMap{}};
  for (KeyFrameId id = 0; id < static_cast<KeyFrameId>(keyframes); ++id) {
    auto features = std::make_shared<Features>();
    for (std::uint32_t i = 0; i < kFeatures; ++i) {
      features->keypoints.emplace_back(static_cast<float>(uniform(20, 620)),
                                       static_cast<float>(uniform(20, 460)), 31.0F,
                                       static_cast<float>(uniform(0, 360)), 40.0F, i % 8);
      features->descriptors.push_back({random(), random(), random(), random()});
      features->depth.push_back(i % 5 == 0 ? 0.0F : static_cast<float>(uniform(0.5, 5)));
    }
    Vector6d twist;
    for (double& value : twist) value = uniform(-1, 1);
    edit.add_keyframe({.id = id,
                       .frame = 3 * id,
                       .time = 1305031102.25 + 0.1 * id,
                       .world_from_camera = exp_se3(twist),
                       .camera = camera,
                       .features = features,
                       .track_weights = std::vector<std::uint8_t>(kFeatures, 200),
                       .map_weights = std::vector<std::uint8_t>(kFeatures, 150),
                       .landmarks = std::vector<LandmarkId>(kFeatures, kNoId)});
    for (std::uint32_t i = 0; i < kFeatures; ++i) {
      LandmarkId landmark = i;  // every key frame sees the same ones, but for the last ten features
      if (id == 0 || i >= 30)
        landmark = edit.add_landmark({.position_in_world = {uniform(-3, 3), 1, 2},
                                      .mean_view = Eigen::Vector3d(1, 2, 3).normalized(),
                                      .min_distance = 0.5F,
                                      .max_distance = 4.25F,
                                      .descriptor = features->descriptors[i],
                                      .created_by = id,
                                      .visible = 9,
                                      .found = 7,
                                      .static_log_odds = 1.25F});
      edit.add_observation(landmark, {id, i});
    }
    edit.update_covisibility(id);
  }
  if (keyframes > 3) edit.remove_keyframe(2);
  edit.remove_landmark(5);
  return std::move(edit).finish();
}

void expect_same(const SparseMap& a, const SparseMap& b) {
  ASSERT_EQ(a.keyframe_count(), b.keyframe_count());
  ASSERT_EQ(a.landmark_count(), b.landmark_count());
  KeyFrameId other = 0;
  for (KeyFrameId id = 0; id < a.keyframe_id_end(); ++id) {
    const KeyFrame* x = a.keyframe(id);
    if (!x) continue;
    const KeyFrame* y = b.keyframe(other++);
    EXPECT_EQ(x->world_from_camera.matrix(), y->world_from_camera.matrix());
    EXPECT_EQ(x->time, y->time);
    EXPECT_EQ(x->frame, y->frame);
    EXPECT_EQ(x->track_weights, y->track_weights);
    EXPECT_EQ(x->map_weights, y->map_weights);
    EXPECT_EQ(x->features->descriptors, y->features->descriptors);
    EXPECT_EQ(x->features->depth, y->features->depth);
    EXPECT_EQ(x->covisible.size(), y->covisible.size());
    for (std::size_t i = 0; i < x->features->size(); ++i) {
      EXPECT_EQ(x->features->keypoints[i].pt, y->features->keypoints[i].pt);
      EXPECT_EQ(x->features->keypoints[i].octave, y->features->keypoints[i].octave);
      const Landmark* seen = a.landmark(x->landmarks[i]);
      const Landmark* read = b.landmark(y->landmarks[i]);
      ASSERT_EQ(seen == nullptr, read == nullptr);
      if (!seen) continue;
      EXPECT_EQ(seen->position_in_world, read->position_in_world);
      EXPECT_EQ(seen->mean_view, read->mean_view);
      EXPECT_EQ(seen->descriptor, read->descriptor);
      EXPECT_EQ(seen->max_distance, read->max_distance);
      EXPECT_EQ(seen->found, read->found);
      EXPECT_EQ(seen->static_log_odds, read->static_log_odds);
      EXPECT_EQ(seen->observations.size(), read->observations.size());
    }
  }
}

std::string read_bytes(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

class MapFile : public ::testing::Test {
 protected:
  void write_bytes(const std::string& bytes) const {
    std::ofstream(file_, std::ios::binary) << bytes;
  }
  void expect_refused(const std::string& why) const {
    const std::string before = read_bytes(file_);
    try {
      load_map(file_);
      FAIL() << "accepted; expected: " << why;
    } catch (const Error& error) {
      EXPECT_EQ(error.fault(), Fault::kData);
      EXPECT_THAT(error.what(), HasSubstr(file_.string()));
      EXPECT_THAT(error.what(), HasSubstr(why));
    }
    EXPECT_EQ(read_bytes(file_), before) << "a file that is refused stays as it is";
  }
  void execute(const std::string& sql) const {
    sqlite3* database = nullptr;
    ASSERT_EQ(sqlite3_open(file_.c_str(), &database), SQLITE_OK);
    char* message = nullptr;
    sqlite3_exec(database, sql.c_str(), nullptr, nullptr, &message);
    EXPECT_EQ(message, nullptr) << message;
    sqlite3_close(database);
  }

  testing::TemporaryFolder folder_;
  fs::path file_ = folder_.path() / "map.stillpoint";
};

TEST_F(MapFile, FeaturesOfOtherTrackersMayHaveNoDescriptors) {
  MapEdit map{SparseMap()};
  KeyFrame keyframe{.id = 0};
  keyframe.camera = std::make_shared<const Camera>();
  keyframe.features =
      std::make_shared<const Features>(Features{.keypoints = {{10, 20, 1}}, .depth = {1.5F}});
  keyframe.track_weights = keyframe.map_weights = {255};
  keyframe.landmarks = {kNoId};
  map.add_keyframe(std::move(keyframe));
  save_map(map.map(), file_);
  const SparseMap loaded = load_map(file_);
  expect_same(map.map(), loaded);
  EXPECT_EQ(loaded.keyframe(0)->features->size(), 1u);
}

TEST_F(MapFile, GivesBackWhatWasSaved) {
  const SparseMap map = small_map();
  save_map(map, file_);
  const SparseMap loaded = load_map(file_);
  EXPECT_EQ(loaded.check(), std::nullopt);
  expect_same(map, loaded);
  EXPECT_EQ(loaded.keyframe_id_end(), loaded.keyframe_count()) << "ids without gaps";
  EXPECT_EQ(loaded.keyframe(0)->camera, loaded.keyframe(1)->camera) << "one camera, kept once";
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 1) << "nothing else is left";
}

TEST_F(MapFile, SavingTwiceGivesTheSameBytes) {
  save_map(small_map(), file_);
  const std::string first = read_bytes(file_);
  save_map(load_map(file_), file_);
  EXPECT_EQ(read_bytes(file_), first);
}

TEST_F(MapFile, AnEmptyMapIsAMap) {
  save_map(SparseMap{}, file_);
  EXPECT_TRUE(load_map(file_).empty());
}

TEST_F(MapFile, MissingForeignAndNewerFilesAreRefused) {
  EXPECT_THROW(load_map(file_), Error);
  write_bytes("this is a diary");
  expect_refused("not a database");
  write_bytes("");
  expect_refused("no map of Stillpoint");
  fs::remove(file_);
  execute("CREATE TABLE birds (name TEXT)");
  expect_refused("no map of Stillpoint");
  save_map(small_map(), file_);
  execute("PRAGMA user_version = 7");
  expect_refused("its version is 7");
}

TEST_F(MapFile, TruncatedFilesAreRefused) {
  save_map(small_map(), file_);
  const std::string whole = read_bytes(file_);
  for (const double share : {0.01, 0.1, 0.5, 0.9, 0.999}) {
    write_bytes(
        whole.substr(0, static_cast<std::size_t>(share * static_cast<double>(whole.size()))));
    EXPECT_THROW(load_map(file_), Error) << share;
  }
}

// Either refused with a message or, where it hit unused bytes, read as it was.
TEST_F(MapFile, DamagedBytesNeverCrash) {
  const SparseMap map = small_map();
  save_map(map, file_);
  const std::string whole = read_bytes(file_);
  std::mt19937_64 random(1);
  int refused = 0;
  for (int i = 0; i < 200; ++i) {
    std::string damaged = whole;
    damaged[random() % whole.size()] ^= static_cast<char>(1 + random() % 255);
    write_bytes(damaged);
    try {
      expect_same(map, load_map(file_));
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 50);
}

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

TEST_F(MapFile, WhatCannotBeWrittenIsSaid) {
  try {
    save_map(small_map(3), "/proc/nowhere/map");
    FAIL() << "written";
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kUsage);
    EXPECT_THAT(error.what(), HasSubstr("/proc/nowhere: cannot write: "));
  }
}

TEST_F(MapFile, WithoutRoomTheEarlierFileStays) {
  save_map(small_map(), file_);
  const std::string before = read_bytes(file_);
  rlimit unlimited{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &unlimited), 0);
  const rlimit small{.rlim_cur = 4096, .rlim_max = unlimited.rlim_max};  // bytes
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ::setrlimit(RLIMIT_FSIZE, &small);
  EXPECT_THROW(save_map(small_map(30), file_), Error);
  ::setrlimit(RLIMIT_FSIZE, &unlimited);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(read_bytes(file_), before);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 1) << "nothing else is left";
}

TEST_F(MapFile, WhatIsNoFileStays) {
  ASSERT_EQ(::mkfifo(file_.c_str(), 0600), 0);
  EXPECT_THROW(save_map(small_map(), file_), Error);
  EXPECT_TRUE(fs::is_fifo(file_));
  EXPECT_THROW(save_map(small_map(), folder_.path()), Error);
}

TEST_F(MapFile, FilesBesideItStay) {
  const fs::path mine = file_.string() + ".part";
  std::ofstream(mine) << "mine";
  save_map(small_map(), file_);
  EXPECT_EQ(read_bytes(mine), "mine");
}

// The kernel ends the process where the new file would grow beyond a limit, at forty places of it.
TEST_F(MapFile, ADyingProcessLeavesTheEarlierFile) {
  constexpr int kPlaces = 40;
  const SparseMap earlier = small_map(3), later = small_map(30);
  save_map(later, file_);
  const auto size = fs::file_size(file_);
  save_map(earlier, file_);
  for (int i = 0; i < kPlaces; ++i) {
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      const rlimit no_core{0, 0}, bytes{size * i / kPlaces, size * i / kPlaces};
      ::setrlimit(RLIMIT_CORE, &no_core);
      ::setrlimit(RLIMIT_FSIZE, &bytes);
      save_map(later, file_);
      ::_exit(0);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGXFSZ) << i;
    ASSERT_EQ(load_map(file_).keyframe_count(), earlier.keyframe_count()) << i;
  }
  save_map(later, file_);  // what the dead have left is in nobody's way
  EXPECT_EQ(load_map(file_).keyframe_count(), later.keyframe_count());
}

}  // namespace
}  // namespace stillpoint
