// How a sparse map lies in a file of SQLite: what its writer and its reader agree on.
//
// Tables: camera, keyframe, landmark, numbered from 0. What there is once per feature lies in blobs
// of the key frame, in the machine's byte order (little-endian wherever Stillpoint runs). The last
// column of every table is a CRC-32 over the others. Camera::surface_noise is left out: it belongs
// to depth images, which are not kept.
#pragma once

#include <cstdint>

namespace stillpoint {

inline constexpr int kMapVersion = 1;
inline constexpr std::int64_t kMapApplication = 0x53504d31;  // in the file's header: "SPM1"

inline constexpr const char* kMapTables = R"(
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

}  // namespace stillpoint
