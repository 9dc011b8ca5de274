#include "stillpoint/runtime/map_reader.hpp"

#include <algorithm>
#include <boost/crc.hpp>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "stillpoint/runtime/map_layout.hpp"
#include "stillpoint/runtime/map_values.hpp"
#include "stillpoint/runtime/sqlite_file.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;

void require(bool condition, const std::string& what) {
  if (!condition) throw DamagedMap(what);
}

template <class T>
std::vector<T> values_of(std::span<const std::byte> bytes, std::size_t count,
                         const std::string& what) {
  require(bytes.size() % sizeof(T) == 0 && bytes.size() / sizeof(T) == count,
          what + " has another length");
  std::vector<T> values(count);
  if (count > 0) std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

/// A number of the file as one of the program's, which may be smaller.
template <class T>
T integer_of(std::int64_t number) {
  require(std::in_range<T>(number), "a number is out of range");
  return static_cast<T>(number);
}

/// Of a key frame; negative: none.
KeyFrameId id_of(std::int64_t number) {
  return number < 0 ? kNoId : integer_of<KeyFrameId>(number);
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
    require(number("PRAGMA application_id") == kMapApplication, "it is no map of Stillpoint");
    const std::int64_t version = number("PRAGMA user_version");
    require(version >= 1, "it has no version");
    require(version <= kMapVersion, "its version is " + std::to_string(version) +
                                        ", this program knows up to " +
                                        std::to_string(kMapVersion));
    const std::int64_t bytes = number("PRAGMA page_count") * number("PRAGMA page_size");
    require(bytes == static_cast<std::int64_t>(bytes_), "it is not whole");
    require(tables() == kMapTables, "its tables are not those of a map");
    SqliteStatement check = database_.prepare("PRAGMA integrity_check(1)");
    require(check.step() && check.text(0) == "ok", "its pages are damaged");
  }

  /// Compared as text: computed columns and checks would be SQL of the file.
  std::string tables() {
    std::string text = "\n";
    SqliteStatement query = database_.prepare("SELECT sql FROM sqlite_schema ORDER BY rowid");
    while (query.step()) text += query.text(0) + ";\n";
    return text;
  }

  void read_cameras() {
    RowReader row(database_, "camera");
    while (row.step()) {
      auto camera = std::make_shared<Camera>();
      camera->width = integer_of<int>(row->integer(1));
      camera->height = integer_of<int>(row->integer(2));
      camera->fx = row->real(3);
      camera->fy = row->real(4);
      camera->cx = row->real(5);
      camera->cy = row->real(6);
      camera->depth_noise = row->real(7);
      check_values(*camera);
      cameras_.push_back(std::move(camera));
    }
  }

  // Without observations yet.
  void read_landmarks() {
    RowReader row(database_, "landmark");
    while (row.step()) {
      Landmark landmark;
      references_.push_back(id_of(row->integer(1)));
      landmark.created_by = id_of(row->integer(2));
      for (int i = 0; i < 3; ++i) landmark.position_in_world[i] = row->real(3 + i);
      for (int i = 0; i < 3; ++i) landmark.mean_view[i] = row->real(6 + i);
      landmark.min_distance = static_cast<float>(row->real(9));
      landmark.max_distance = static_cast<float>(row->real(10));
      landmark.visible = integer_of<std::uint32_t>(row->integer(11));
      landmark.found = integer_of<std::uint32_t>(row->integer(12));
      landmark.static_log_odds = static_cast<float>(row->real(13));
      const auto words = values_of<std::uint64_t>(row->bytes(14), 4, "a descriptor");
      std::ranges::copy(words, landmark.descriptor.begin());
      check_values(landmark);
      edit_.add_landmark(landmark);
    }
  }

  void read_keyframes() {
    RowReader row(database_, "keyframe");
    while (row.step()) edit_.add_keyframe(keyframe(row));
  }

  KeyFrame keyframe(const RowReader& row) const {
    const auto count = integer_of<std::size_t>(row->integer(6));
    const auto camera = integer_of<std::size_t>(row->integer(3));
    require(camera < cameras_.size(), "a camera is missing");
    auto features = std::make_shared<Features>();
    features->scale_factor = row->real(4);
    features->levels = integer_of<int>(row->integer(5));
    for (const auto& k : values_of<StoredKeypoint>(row->bytes(8), count, "keypoints"))
      features->keypoints.emplace_back(k.x, k.y, k.size, k.angle, k.response, k.octave);
    if (!row->bytes(9).empty())
      features->descriptors = values_of<Descriptor>(row->bytes(9), count, "descriptors");
    features->depth = values_of<float>(row->bytes(10), count, "depth");

    KeyFrame keyframe;
    keyframe.id = integer_of<KeyFrameId>(row->integer(0));
    keyframe.frame = integer_of<std::uint32_t>(row->integer(1));
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
    check_values(keyframe);
    return keyframe;
  }

  SqliteFile database_;
  std::uintmax_t bytes_;  // of the file
  MapEdit edit_{SparseMap{}};
  std::vector<std::shared_ptr<const Camera>> cameras_;
  std::vector<KeyFrameId> references_;  // of the landmarks
};

}  // namespace

SparseMap read_map(const fs::path& file) { return MapReader(file).read(); }

}  // namespace stillpoint
