#include "stillpoint/runtime/map_writer.hpp"

#include <boost/crc.hpp>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "stillpoint/runtime/map_layout.hpp"
#include "stillpoint/runtime/sqlite_file.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;

template <class T>
std::span<const std::byte> bytes_of(const std::vector<T>& values) {
  return std::as_bytes(std::span(values));
}

// Number of each element in the file, by id: 0, 1, 2 …; -1 when it was removed.
template <class Id>
std::vector<std::int64_t> numbered(std::size_t id_end, const auto& is_there) {
  std::vector<std::int64_t> number(id_end, -1);
  std::int64_t next = 0;
  for (Id id = 0; id < id_end; ++id)
    if (is_there(id)) number[id] = next++;
  return number;
}

// Writes a row and its checksum.
class RowWriter {
 public:
  RowWriter(SqliteFile& database, const std::string& table, int columns)
      : insert_(
            database.prepare("INSERT INTO " + table + " VALUES (" + placeholders(columns) + ")")) {}

  RowWriter& add(std::int64_t value) {
    insert_.bind(value);
    return sum(static_cast<double>(value));
  }
  RowWriter& add(double value) {
    insert_.bind(value);
    return sum(value);
  }
  RowWriter& add(std::span<const std::byte> bytes) {
    insert_.bind(bytes);
    crc_.process_bytes(bytes.data(), bytes.size());
    return *this;
  }
  void write() {
    insert_.bind(std::int64_t{crc_.checksum()}).run();
    crc_.reset();
  }

 private:
  static std::string placeholders(int columns) {
    std::string text = "?";
    for (int i = 1; i < columns; ++i) text += ", ?";
    return text;
  }
  RowWriter& sum(double value) {
    crc_.process_bytes(&value, sizeof value);
    return *this;
  }

  SqliteStatement insert_;
  boost::crc_32_type crc_;
};

class MapWriter {
 public:
  MapWriter(const SparseMap& map, const fs::path& file)
      : map_(map),
        database_(file, SqliteFile::Mode::kCreate),
        keyframe_number_(numbered<KeyFrameId>(map.keyframe_id_end(),
                                              [&](KeyFrameId id) { return map.keyframe(id); })),
        landmark_number_(numbered<LandmarkId>(map.landmark_id_end(),
                                              [&](LandmarkId id) { return map.landmark(id); })) {}

  void write() {
    // No journal: the file is made beside the earlier one and takes its place when it is whole.
    database_.execute("PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF;");
    database_.execute("PRAGMA application_id = " + std::to_string(kMapApplication) +
                      "; PRAGMA user_version = " + std::to_string(kMapVersion) + ";");
    database_.execute("BEGIN");
    database_.execute(kMapTables);
    write_keyframes();
    write_landmarks();
    database_.execute("COMMIT");
    database_.close();
  }

 private:
  std::int64_t number_of(KeyFrameId id) const {
    return id < keyframe_number_.size() ? keyframe_number_[id] : -1;
  }

  std::int64_t camera_number(const std::shared_ptr<const Camera>& camera) {
    const auto [entry, is_new] =
        cameras_.try_emplace(camera.get(), static_cast<std::int64_t>(cameras_.size()));
    if (is_new)
      RowWriter(database_, "camera", 9)
          .add(entry->second)
          .add(std::int64_t{camera->width})
          .add(std::int64_t{camera->height})
          .add(camera->fx)
          .add(camera->fy)
          .add(camera->cx)
          .add(camera->cy)
          .add(camera->depth_noise)
          .write();
    return entry->second;
  }

  void write_keyframes() {
    RowWriter row(database_, "keyframe", 15);
    for (KeyFrameId id = 0; id < map_.keyframe_id_end(); ++id)
      if (const KeyFrame* keyframe = map_.keyframe(id)) write(*keyframe, row);
  }

  void write(const KeyFrame& keyframe, RowWriter& row) {
    const Features& features = *keyframe.features;
    std::vector<StoredKeypoint> keypoints;
    for (const cv::KeyPoint& k : features.keypoints)
      keypoints.push_back({k.pt.x, k.pt.y, k.size, k.angle, k.response, k.octave});
    std::vector<std::int32_t> landmarks;
    for (const LandmarkId id : keyframe.landmarks)
      landmarks.push_back(map_.landmark(id) ? static_cast<std::int32_t>(landmark_number_[id]) : -1);
    row.add(number_of(keyframe.id))
        .add(std::int64_t{keyframe.frame})
        .add(keyframe.time)
        .add(camera_number(keyframe.camera))
        .add(features.scale_factor)
        .add(std::int64_t{features.levels})
        .add(static_cast<std::int64_t>(features.size()))
        .add(std::as_bytes(std::span(keyframe.world_from_camera.data(), 16)))
        .add(bytes_of(keypoints))
        .add(bytes_of(features.descriptors))
        .add(bytes_of(features.depth))
        .add(bytes_of(keyframe.track_weights))
        .add(bytes_of(keyframe.map_weights))
        .add(bytes_of(landmarks))
        .write();
  }

  void write_landmarks() {
    RowWriter row(database_, "landmark", 16);
    for (LandmarkId id = 0; id < map_.landmark_id_end(); ++id) {
      const Landmark* landmark = map_.landmark(id);
      if (!landmark) continue;
      row.add(landmark_number_[id])
          .add(number_of(landmark->reference))
          .add(number_of(landmark->created_by));
      for (const double value : landmark->position_in_world) row.add(value);
      for (const double value : landmark->mean_view) row.add(value);
      row.add(double{landmark->min_distance})
          .add(double{landmark->max_distance})
          .add(std::int64_t{landmark->visible})
          .add(std::int64_t{landmark->found})
          .add(double{landmark->static_log_odds})
          .add(std::as_bytes(std::span(landmark->descriptor)))
          .write();
    }
  }

  const SparseMap& map_;
  SqliteFile database_;
  std::vector<std::int64_t> keyframe_number_, landmark_number_;  // in the file, by id
  std::map<const Camera*, std::int64_t> cameras_;
};

}  // namespace

void write_map(const SparseMap& map, const fs::path& file) { MapWriter(map, file).write(); }

}  // namespace stillpoint
