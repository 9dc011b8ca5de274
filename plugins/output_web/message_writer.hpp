// Messages to viewers: little-endian numbers in records, as README.md lays them out.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <stillpoint/sdk.hpp>
#include <string>
#include <string_view>
#include <type_traits>

namespace stillpoint::output_web {

/// First byte of every message, in both directions. Raised when a layout changes.
inline constexpr std::uint8_t kProtocol = 3;

enum class Record : std::uint8_t {
  kRunInfo = 1,
  kStages = 2,
  kFrames = 3,
  kTimes = 4,
  kImage = 5,
  kFeatures = 6,
  kMovingPoints = 7,
  kMask = 8,
  kKeyFrames = 9,
  kLandmarks = 10,
  kCloud = 11,
  kLoops = 12,
  kTruth = 13,
  kEnd = 14,
  kSteering = 15,
  kVoxels = 16,
  kVoxelsRemoved = 17,
  kLeftOut = 18
};

/// Appends to a string of bytes.
class MessageWriter {
 public:
  /// Everything until end() is one record: its kind, the size of what follows, and that.
  void begin(Record kind) {
    number(static_cast<std::uint8_t>(kind));
    number(std::uint32_t{0});
    begin_ = bytes_.size();
  }
  void end() { put_at(begin_ - sizeof(std::uint32_t), count_of(bytes_.size() - begin_)); }

  template <class T>
  requires std::is_arithmetic_v<T>
  void number(T value) {
    static_assert(std::endian::native == std::endian::little);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof(value));
  }
  void text(std::string_view text) { bytes_.append(text); }
  void point(const Eigen::Vector3d& point) {
    for (const double value : point) number(static_cast<float>(value));
  }
  /// Translation, then the quaternion x, y, z, w.
  void pose(const Pose& pose) {
    point(pose.translation());
    const Eigen::Quaterniond rotation(pose.linear());
    for (const double value : rotation.coeffs()) number(static_cast<float>(value));
  }
  /// Room for a count that is known later; gives its place.
  std::size_t count() {
    number(std::uint32_t{0});
    return bytes_.size() - sizeof(std::uint32_t);
  }
  void set_count(std::size_t place, std::size_t value) { put_at(place, count_of(value)); }

  std::size_t size() const { return bytes_.size(); }
  std::string take() { return std::move(bytes_); }

 private:
  static std::uint32_t count_of(std::size_t value) { return static_cast<std::uint32_t>(value); }
  void put_at(std::size_t place, std::uint32_t value) {
    bytes_.replace(place, sizeof(value), reinterpret_cast<const char*>(&value), sizeof(value));
  }

  std::string bytes_;
  std::size_t begin_ = 0;  // of the record's content
};

}  // namespace stillpoint::output_web
