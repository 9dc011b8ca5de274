// A small map, and a file for it.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include "stillpoint/engine/map_file.hpp"
#include "stillpoint/error.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint {

// Key frames that share landmarks, one of them removed, some landmarks gone.
inline SparseMap small_map(int keyframes = 6, std::uint64_t seed = 4) {
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

inline void expect_same(const SparseMap& a, const SparseMap& b) {
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

inline std::string read_bytes(const std::filesystem::path& file) {
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
      EXPECT_THAT(error.what(), ::testing::HasSubstr(file_.string()));
      EXPECT_THAT(error.what(), ::testing::HasSubstr(why));
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
  std::filesystem::path file_ = folder_.path() / "map.stillpoint";
};

}  // namespace stillpoint
