#include "stillpoint/runtime/map_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <boost/crc.hpp>
#include <cerrno>
#include <cstring>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "stillpoint/error.hpp"
#include "stillpoint/runtime/sqlite_file.hpp"

// Tables: camera, keyframe, landmark, numbered from 0. What there is once per feature lies in blobs
// of the key frame, in the machine's byte order (little-endian wherever Stillpoint runs). The last
// column of every table is a CRC-32 over the others.
namespace stillpoint {
namespace {

namespace fs = std::filesystem;

constexpr int kVersion = 1;                        // of the layout
constexpr std::int64_t kApplication = 0x53504d31;  // in the file's header: "SPM1"

constexpr const char* kLayout = R"(
CREATE TABLE camera (id INTEGER PRIMARY KEY, width INTEGER, height INTEGER,
  fx REAL, fy REAL, cx REAL, cy REAL, depth_noise REAL, crc INTEGER);
CREATE TABLE keyframe (id INTEGER PRIMARY KEY, frame INTEGER, time REAL, camera INTEGER,
  scale_factor REAL, levels INTEGER, features INTEGER, world_from_camera BLOB, keypoints BLOB,
  descriptors BLOB, depth BLOB, track_weights BLOB, map_weights BLOB, landmarks BLOB, crc INTEGER);
CREATE TABLE landmark (id INTEGER PRIMARY KEY, reference INTEGER, created_by INTEGER,
  x REAL, y REAL, z REAL, view_x REAL, view_y REAL, view_z REAL, min_distance REAL,
  max_distance REAL, visible INTEGER, found INTEGER, static_log_odds REAL, descriptor BLOB,
  crc INTEGER);
)";

struct StoredKeypoint {
  float x, y, size, angle, response;
  std::int32_t octave;
};

template <class T>
std::span<const std::byte> bytes_of(const std::vector<T>& values) {
  return std::as_bytes(std::span(values));
}

// Numbers in the file: 0, 1, 2 … of what is there.
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
    database_.execute("PRAGMA application_id = " + std::to_string(kApplication) +
                      "; PRAGMA user_version = " + std::to_string(kVersion) + ";");
    database_.execute("BEGIN");
    database_.execute(kLayout);
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

// Anything in a file that cannot be; caught where the file is known.
class DamagedMap : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

void require(bool condition, const std::string& what) {
  if (!condition) throw DamagedMap(what);
}

template <class T>
std::vector<T> values_of(std::span<const std::byte> bytes, std::size_t count,
                         const std::string& what) {
  require(bytes.size() == count * sizeof(T), what + " has another length");
  std::vector<T> values(count);
  if (count > 0) std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

// The rows of a table in order, verified.
class RowReader {
 public:
  RowReader(SqliteFile& database, const std::string& table)
      : rows_(database.prepare("SELECT * FROM " + table + " ORDER BY id")), table_(table) {}

  bool step() {
    if (!rows_.step()) return false;
    boost::crc_32_type crc;
    const int last = rows_.columns() - 1;
    for (int i = 0; i < last; ++i) {
      if (rows_.is_number(i)) {
        const double value = rows_.real(i);
        crc.process_bytes(&value, sizeof value);
      } else {
        crc.process_bytes(rows_.bytes(i).data(), rows_.bytes(i).size());
      }
    }
    require(crc.checksum() == rows_.integer(last), "a " + table_ + " is damaged");
    require(rows_.integer(0) == count_++, "a " + table_ + " is missing");
    return true;
  }
  const SqliteStatement* operator->() const { return &rows_; }

 private:
  SqliteStatement rows_;
  std::string table_;
  std::int64_t count_ = 0;
};

class MapReader {
 public:
  explicit MapReader(const fs::path& file)
      : database_(file, SqliteFile::Mode::kRead), bytes_(fs::file_size(file)) {}

  SparseMap read() {
    check_header();
    read_cameras();
    read_landmarks();
    read_keyframes();
    for (LandmarkId id = 0; id < references_.size(); ++id)
      edit_.landmark(id).reference = references_[id];
    for (KeyFrameId id = 0; id < edit_.map().keyframe_id_end(); ++id) edit_.update_covisibility(id);
    SparseMap map = std::move(edit_).finish();
    if (const auto fault = map.check()) throw DamagedMap(*fault);
    return map;
  }

 private:
  std::int64_t number(const std::string& sql) {
    SqliteStatement query = database_.prepare(sql);
    require(query.step(), "'" + sql + "' gives nothing");
    return query.integer(0);
  }

  void check_header() {
    require(number("PRAGMA application_id") == kApplication, "it is no map of Stillpoint");
    const std::int64_t version = number("PRAGMA user_version");
    require(version <= kVersion, "its version is " + std::to_string(version) +
                                     ", this program knows up to " + std::to_string(kVersion));
    const std::int64_t bytes = number("PRAGMA page_count") * number("PRAGMA page_size");
    require(bytes == static_cast<std::int64_t>(bytes_), "it is not whole");
    SqliteStatement check = database_.prepare("PRAGMA integrity_check(1)");
    require(check.step() && check.text(0) == "ok", "its pages are damaged");
  }

  void read_cameras() {
    RowReader row(database_, "camera");
    while (row.step()) {
      auto camera = std::make_shared<Camera>();
      camera->width = static_cast<int>(row->integer(1));
      camera->height = static_cast<int>(row->integer(2));
      camera->fx = row->real(3);
      camera->fy = row->real(4);
      camera->cx = row->real(5);
      camera->cy = row->real(6);
      camera->depth_noise = row->real(7);
      cameras_.push_back(std::move(camera));
    }
  }

  // Without observations yet.
  void read_landmarks() {
    RowReader row(database_, "landmark");
    while (row.step()) {
      Landmark landmark;
      references_.push_back(static_cast<KeyFrameId>(row->integer(1)));
      landmark.created_by = static_cast<KeyFrameId>(row->integer(2));
      for (int i = 0; i < 3; ++i) landmark.position_in_world[i] = row->real(3 + i);
      for (int i = 0; i < 3; ++i) landmark.mean_view[i] = row->real(6 + i);
      landmark.min_distance = static_cast<float>(row->real(9));
      landmark.max_distance = static_cast<float>(row->real(10));
      landmark.visible = static_cast<std::uint32_t>(row->integer(11));
      landmark.found = static_cast<std::uint32_t>(row->integer(12));
      landmark.static_log_odds = static_cast<float>(row->real(13));
      const auto words = values_of<std::uint64_t>(row->bytes(14), 4, "a descriptor");
      std::ranges::copy(words, landmark.descriptor.begin());
      edit_.add_landmark(landmark);
    }
  }

  void read_keyframes() {
    RowReader row(database_, "keyframe");
    while (row.step()) edit_.add_keyframe(keyframe(row));
  }

  KeyFrame keyframe(const RowReader& row) const {
    const auto count = static_cast<std::size_t>(row->integer(6));
    const auto camera = static_cast<std::size_t>(row->integer(3));
    require(camera < cameras_.size(), "a camera is missing");
    auto features = std::make_shared<Features>();
    features->scale_factor = row->real(4);
    features->levels = static_cast<int>(row->integer(5));
    for (const StoredKeypoint& k : values_of<StoredKeypoint>(row->bytes(8), count, "keypoints"))
      features->keypoints.emplace_back(k.x, k.y, k.size, k.angle, k.response, k.octave);
    features->descriptors = values_of<Descriptor>(row->bytes(9), count, "descriptors");
    features->depth = values_of<float>(row->bytes(10), count, "depth");

    KeyFrame keyframe;
    keyframe.id = static_cast<KeyFrameId>(row->integer(0));
    keyframe.frame = static_cast<std::uint32_t>(row->integer(1));
    keyframe.time = row->real(2);
    keyframe.camera = cameras_[camera];
    const auto pose = values_of<double>(row->bytes(7), 16, "a pose");
    std::ranges::copy(pose, keyframe.world_from_camera.data());
    keyframe.track_weights = values_of<std::uint8_t>(row->bytes(11), count, "weights");
    keyframe.map_weights = values_of<std::uint8_t>(row->bytes(12), count, "weights");
    for (const std::int32_t id : values_of<std::int32_t>(row->bytes(13), count, "landmarks")) {
      require(id < static_cast<std::int64_t>(references_.size()), "a landmark is missing");
      keyframe.landmarks.push_back(id < 0 ? kNoId : static_cast<LandmarkId>(id));
    }
    keyframe.features = std::move(features);
    return keyframe;
  }

  SqliteFile database_;
  std::uintmax_t bytes_;  // of the file
  MapEdit edit_{SparseMap{}};
  std::vector<std::shared_ptr<const Camera>> cameras_;
  std::vector<KeyFrameId> references_;  // of the landmarks
};

[[noreturn]] void cannot_write(const fs::path& file, const std::string& why) {
  throw Error(Fault::kUsage, "the map cannot be written: " + why, file.string(),
              "check the folder's permissions and the free space");
}

// To the disk, so that after a power cut the name stands for a whole file.
void flush(const fs::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) cannot_write(file, std::strerror(errno));
  const int failed = ::fsync(descriptor);
  const int error = errno;
  ::close(descriptor);
  if (failed) cannot_write(file, std::strerror(error));
}

// Written beside its place first.
fs::path part_of(const fs::path& file) { return file.string() + ".part"; }

}  // namespace

void require_writable(const fs::path& file) {
  std::error_code failed;
  if (file.has_parent_path()) fs::create_directories(file.parent_path(), failed);
  if (failed) cannot_write(file, failed.message());
  const int descriptor = ::open(part_of(file).c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0644);
  if (descriptor < 0) cannot_write(file, std::strerror(errno));
  ::close(descriptor);
  fs::remove(part_of(file), failed);
}

void save_map(const SparseMap& map, const fs::path& file) {
  const fs::path part = part_of(file);
  require_writable(file);
  try {
    MapWriter(map, part).write();
    flush(part);
    fs::rename(part, file);
  } catch (const std::exception& fault) {
    std::error_code ignored;
    fs::remove(part, ignored);
    cannot_write(file, fault.what());
  }
}

SparseMap load_map(const fs::path& file) {
  const auto refuse = [&](const std::string& why) {
    return Error(Fault::kData, "this map cannot be used: " + why, file.string(),
                 "give a file that 'stillpoint run --save-map' of this version has written");
  };
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) throw refuse("there is no such file");
  try {
    return MapReader(file).read();
  } catch (const std::exception& fault) {
    throw refuse(fault.what());
  }
}

}  // namespace stillpoint
