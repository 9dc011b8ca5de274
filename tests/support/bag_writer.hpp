// Writes small bags in the three formats, by their descriptions; for tests of what reads them.
#pragma once

#include <bzlib.h>
#include <lz4frame.h>
#include <sqlite3.h>
#include <zstd.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <opencv2/core.hpp>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bag/messages.hpp"

namespace stillpoint::testing {

using bag::Serialisation;

/// Bytes that numbers and texts are put behind; as a message when it has a serialisation.
class ByteWriter {
 public:
  ByteWriter() = default;
  explicit ByteWriter(Serialisation serialisation) : cdr_(serialisation == Serialisation::kCdr) {
    if (cdr_) bytes_ = {0, 1, 0, 0};  // little-endian
  }

  template <class T>
  ByteWriter& number(T value) {
    while (cdr_ && (bytes_.size() - 4) % sizeof(T) != 0) bytes_.push_back(0);
    const auto at = bytes_.size();
    bytes_.resize(at + sizeof(T));
    std::memcpy(&bytes_[at], &value, sizeof(T));
    return *this;
  }
  ByteWriter& text(const std::string& letters) {
    number(static_cast<std::uint32_t>(letters.size() + cdr_));
    raw(letters);
    if (cdr_) bytes_.push_back(0);
    return *this;
  }
  ByteWriter& sequence(const std::vector<std::uint8_t>& bytes) {
    number(static_cast<std::uint32_t>(bytes.size()));
    return raw(bytes);
  }
  template <class Range>
  ByteWriter& raw(const Range& bytes) {
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    return *this;
  }
  const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  bool cdr_ = false;
  std::vector<std::uint8_t> bytes_;
};

using BagBytes = std::vector<std::uint8_t>;

inline ByteWriter message_with_header(Serialisation serialisation, std::int64_t stamp,
                                      const std::string& frame) {
  ByteWriter writer(serialisation);
  if (serialisation == Serialisation::kRos1) writer.number<std::uint32_t>(7);  // seq
  writer.number(static_cast<std::uint32_t>(stamp / 1'000'000'000));
  writer.number(static_cast<std::uint32_t>(stamp % 1'000'000'000));
  return writer.text(frame);
}

/// sensor_msgs/Image; `stamp` in ns.
inline BagBytes image_message(Serialisation serialisation, std::int64_t stamp,
                              const std::string& frame, const cv::Mat& image,
                              const std::string& encoding) {
  ByteWriter writer = message_with_header(serialisation, stamp, frame);
  writer.number(static_cast<std::uint32_t>(image.rows));
  writer.number(static_cast<std::uint32_t>(image.cols));
  writer.text(encoding).number<std::uint8_t>(0);
  writer.number(static_cast<std::uint32_t>(image.cols * image.elemSize()));
  return writer.sequence({image.data, image.data + image.total() * image.elemSize()}).bytes();
}

/// sensor_msgs/CompressedImage.
inline BagBytes compressed_message(Serialisation serialisation, std::int64_t stamp,
                                   const std::string& frame, const std::string& format,
                                   const BagBytes& file) {
  return message_with_header(serialisation, stamp, frame).text(format).sequence(file).bytes();
}

struct TestCameraInfo {
  std::string frame = "color_frame";
  int width = 64, height = 48;
  std::string model = "plumb_bob";
  std::vector<double> distortion = {0, 0, 0, 0, 0};
  double fx = 50, fy = 51, cx = 32, cy = 24;
  double rectified_fx = 45;  ///< of P
};

/// sensor_msgs/CameraInfo.
inline BagBytes camera_info_message(Serialisation serialisation, const TestCameraInfo& info = {}) {
  ByteWriter writer = message_with_header(serialisation, 1'000'000'000, info.frame);
  writer.number(static_cast<std::uint32_t>(info.height));
  writer.number(static_cast<std::uint32_t>(info.width));
  writer.text(info.model).number(static_cast<std::uint32_t>(info.distortion.size()));
  for (const double d : info.distortion) writer.number(d);
  for (const double k : {info.fx, 0., info.cx, 0., info.fy, info.cy, 0., 0., 1.}) writer.number(k);
  for (const double r : {1., 0., 0., 0., 1., 0., 0., 0., 1.}) writer.number(r);
  for (const double p :
       {info.rectified_fx, 0., info.cx, 0., 0., info.fy, info.cy, 0., 0., 0., 1., 0.})
    writer.number(p);
  return writer.bytes();
}

inline BagBytes compressed(const std::string& compression, const BagBytes& bytes) {
  BagBytes result(2 * bytes.size() + (1 << 17));
  if (compression == "bz2") {
    auto size = static_cast<unsigned>(result.size());
    BZ2_bzBuffToBuffCompress(reinterpret_cast<char*>(result.data()), &size,
                             reinterpret_cast<char*>(const_cast<std::uint8_t*>(bytes.data())),
                             static_cast<unsigned>(bytes.size()), 1, 0, 0);
    result.resize(size);
  } else if (compression == "lz4") {
    result.resize(
        LZ4F_compressFrame(result.data(), result.size(), bytes.data(), bytes.size(), nullptr));
  } else if (compression == "zstd") {
    result.resize(ZSTD_compress(result.data(), result.size(), bytes.data(), bytes.size(), 1));
  } else {
    return bytes;
  }
  return result;
}

/// Messages in, a file out.
class BagWriter {
 public:
  virtual ~BagWriter() = default;
  virtual Serialisation serialisation() const = 0;
  /// `time` in ns; `type` as ROS 1 writes it.
  virtual void add(const std::string& topic, const std::string& type, std::int64_t time,
                   const BagBytes& message) = 0;
  virtual void finish() = 0;
};

/// How a bag is written.
struct BagStyle {
  std::string format = "bag";         ///< "bag", "mcap" or "db3"
  std::string compression = "none";   ///< of the chunks
  std::size_t messages_in_chunk = 4;  ///< 0, in MCAP: without chunks
  bool finished = true;               ///< or as a recorder leaves it that was killed
};

class Ros1BagWriter final : public BagWriter {
 public:
  Ros1BagWriter(std::filesystem::path file, BagStyle style)
      : file_(std::move(file)), style_(std::move(style)) {
    out_.raw(std::string("#ROSBAG V2.0\n"));
    header_at_ = out_.bytes().size();
    write_bag_header(0, out_);
  }
  Serialisation serialisation() const override { return Serialisation::kRos1; }

  void add(const std::string& topic, const std::string& type, std::int64_t time,
           const BagBytes& message) override {
    if (!connections_.contains(topic)) {
      const auto number = static_cast<std::uint32_t>(connections_.size());
      connections_[topic] = {number, type};
      write_connection(topic, chunk_);
    }
    const std::uint32_t connection = connections_[topic].first;
    index_[connection].number(seconds_of(time)).number(nanoseconds_of(time));
    index_[connection].number(static_cast<std::uint32_t>(chunk_.bytes().size()));
    record({{"op", {2}}, {"conn", bytes_of(connection)}, {"time", time_bytes(time)}}, message,
           chunk_);
    if (++in_chunk_ == style_.messages_in_chunk) end_chunk();
  }

  void finish() override {
    if (in_chunk_ > 0) end_chunk();
    const auto index_at = static_cast<std::uint64_t>(out_.bytes().size());
    if (style_.finished) {
      for (const auto& [topic, connection] : connections_) write_connection(topic, out_);
      for (const std::uint64_t at : chunks_)
        record({{"op", {6}}, {"ver", bytes_of<std::uint32_t>(1)}, {"chunk_pos", bytes_of(at)}}, {},
               out_);
    }
    BagBytes all = out_.bytes();
    ByteWriter header;
    write_bag_header(style_.finished ? index_at : 0, header);
    std::copy(header.bytes().begin(), header.bytes().end(),
              all.begin() + static_cast<std::ptrdiff_t>(header_at_));
    std::ofstream(file_, std::ios::binary)
        .write(reinterpret_cast<const char*>(all.data()), static_cast<std::streamsize>(all.size()));
  }

 private:
  using Fields = std::vector<std::pair<std::string, BagBytes>>;

  template <class T>
  static BagBytes bytes_of(T value) {
    return ByteWriter().number(value).bytes();
  }
  static BagBytes letters(const std::string& text) { return {text.begin(), text.end()}; }
  static std::uint32_t seconds_of(std::int64_t time) {
    return static_cast<std::uint32_t>(time / 1'000'000'000);
  }
  static std::uint32_t nanoseconds_of(std::int64_t time) {
    return static_cast<std::uint32_t>(time % 1'000'000'000);
  }
  static BagBytes time_bytes(std::int64_t time) {
    return ByteWriter().number(seconds_of(time)).number(nanoseconds_of(time)).bytes();
  }
  static BagBytes header(const Fields& fields) {
    ByteWriter header;
    for (const auto& [name, value] : fields) {
      header.number(static_cast<std::uint32_t>(name.size() + 1 + value.size()));
      header.raw(name + "=").raw(value);
    }
    return header.bytes();
  }
  static void record(const Fields& fields, const BagBytes& data, ByteWriter& out) {
    out.sequence(header(fields)).sequence(data);
  }
  void write_bag_header(std::uint64_t index_at, ByteWriter& out) const {
    record({{"op", {3}},
            {"index_pos", bytes_of(index_at)},
            {"conn_count", bytes_of(static_cast<std::uint32_t>(connections_.size()))},
            {"chunk_count", bytes_of(static_cast<std::uint32_t>(chunks_.size()))}},
           BagBytes(100, ' '), out);
  }
  void write_connection(const std::string& topic, ByteWriter& out) const {
    const auto& [number, type] = connections_.at(topic);
    record({{"op", {7}}, {"conn", bytes_of(number)}, {"topic", letters(topic)}},
           header({{"topic", letters(topic)}, {"type", letters(type)}, {"md5sum", letters("*")}}),
           out);
  }
  void end_chunk() {
    chunks_.push_back(out_.bytes().size());
    record({{"op", {5}},
            {"compression", letters(style_.compression)},
            {"size", bytes_of(static_cast<std::uint32_t>(chunk_.bytes().size()))}},
           compressed(style_.compression, chunk_.bytes()), out_);
    for (const auto& [connection, entries] : index_)
      record({{"op", {4}}, {"ver", bytes_of<std::uint32_t>(1)}, {"conn", bytes_of(connection)}},
             entries.bytes(), out_);
    chunk_ = {};
    index_.clear();
    in_chunk_ = 0;
  }

  std::filesystem::path file_;
  BagStyle style_;
  ByteWriter out_, chunk_;
  std::size_t header_at_ = 0;
  std::size_t in_chunk_ = 0;
  std::map<std::string, std::pair<std::uint32_t, std::string>> connections_;
  std::map<std::uint32_t, ByteWriter> index_;
  std::vector<std::uint64_t> chunks_;
};

/// "sensor_msgs/msg/Image" of "sensor_msgs/Image".
inline std::string ros2_type(std::string type) { return type.insert(type.find('/'), "/msg"); }

class McapWriter final : public BagWriter {
 public:
  McapWriter(std::filesystem::path file, BagStyle style)
      : file_(std::move(file)), style_(std::move(style)) {
    out_.raw(magic());
    record(1, ByteWriter().text("ros2").text("test"), out_);
  }
  Serialisation serialisation() const override { return Serialisation::kCdr; }

  void add(const std::string& topic, const std::string& type, std::int64_t time,
           const BagBytes& message) override {
    ByteWriter& out = style_.messages_in_chunk == 0 ? out_ : chunk_;
    if (!channels_.contains(topic)) {
      channels_[topic] = {static_cast<std::uint16_t>(channels_.size() + 1), type};
      write_channel(topic, out);
    }
    const std::uint16_t channel = channels_[topic].first;
    index_[channel].number<std::uint64_t>(time).number<std::uint64_t>(chunk_.bytes().size());
    record(5,
           ByteWriter()
               .number(channel)
               .number<std::uint32_t>(0)
               .number<std::uint64_t>(time)
               .number<std::uint64_t>(time)
               .raw(message),
           out);
    if (++in_chunk_ == style_.messages_in_chunk) end_chunk();
  }

  void finish() override {
    if (style_.messages_in_chunk > 0 && in_chunk_ > 0) end_chunk();
    if (style_.finished) {
      record(15, ByteWriter().number<std::uint32_t>(0), out_);
      const auto summary = static_cast<std::uint64_t>(out_.bytes().size());
      for (const auto& [topic, channel] : channels_) write_channel(topic, out_);
      for (const auto& [begin, size] : chunks_)
        record(8,
               ByteWriter().number<std::uint64_t>(0).number<std::uint64_t>(0).number(begin).number(
                   size),
               out_);
      record(2, ByteWriter().number(summary).number<std::uint64_t>(0).number<std::uint32_t>(0),
             out_);
      out_.raw(magic());
    }
    std::ofstream(file_, std::ios::binary)
        .write(reinterpret_cast<const char*>(out_.bytes().data()),
               static_cast<std::streamsize>(out_.bytes().size()));
  }

 private:
  static std::string magic() { return "\x89MCAP0\r\n"; }
  static void record(std::uint8_t opcode, const ByteWriter& content, ByteWriter& out) {
    out.number(opcode).number<std::uint64_t>(content.bytes().size()).raw(content.bytes());
  }
  void write_channel(const std::string& topic, ByteWriter& out) const {
    const auto& [number, type] = channels_.at(topic);
    record(
        3,
        ByteWriter().number(number).text(ros2_type(type)).text("ros2msg").number<std::uint32_t>(0),
        out);
    record(
        4,
        ByteWriter().number(number).number(number).text(topic).text("cdr").number<std::uint32_t>(0),
        out);
  }
  void end_chunk() {
    const auto begin = static_cast<std::uint64_t>(out_.bytes().size());
    const BagBytes stored = compressed(style_.compression, chunk_.bytes());
    ByteWriter chunk;
    chunk.number<std::uint64_t>(0).number<std::uint64_t>(0);
    chunk.number<std::uint64_t>(chunk_.bytes().size()).number<std::uint32_t>(0);
    chunk.text(style_.compression == "none" ? "" : style_.compression);
    chunk.number<std::uint64_t>(stored.size()).raw(stored);
    record(6, chunk, out_);
    chunks_.emplace_back(begin, out_.bytes().size() - begin);
    for (const auto& [channel, entries] : index_)
      record(7, ByteWriter().number(channel).sequence(entries.bytes()), out_);
    chunk_ = {};
    index_.clear();
    in_chunk_ = 0;
  }

  std::filesystem::path file_;
  BagStyle style_;
  ByteWriter out_, chunk_;
  std::size_t in_chunk_ = 0;
  std::map<std::string, std::pair<std::uint16_t, std::string>> channels_;
  std::map<std::uint16_t, ByteWriter> index_;
  std::vector<std::pair<std::uint64_t, std::uint64_t>> chunks_;
};

class Ros2DatabaseWriter final : public BagWriter {
 public:
  Ros2DatabaseWriter(const std::filesystem::path& file, BagStyle style)
      : style_(std::move(style)), database_(nullptr, &sqlite3_close) {
    sqlite3* handle = nullptr;
    sqlite3_open(file.c_str(), &handle);
    database_.reset(handle);
    execute(
        "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
        "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);"
        "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, "
        "timestamp INTEGER NOT NULL, data BLOB NOT NULL);"
        "CREATE INDEX timestamp_idx ON messages (timestamp ASC);"
        "BEGIN");
  }
  Serialisation serialisation() const override { return Serialisation::kCdr; }

  void add(const std::string& topic, const std::string& type, std::int64_t time,
           const BagBytes& message) override {
    if (!topics_.contains(topic)) {
      topics_[topic] = static_cast<int>(topics_.size() + 1);
      execute("INSERT INTO topics VALUES(" + std::to_string(topics_[topic]) + ", '" + topic +
              "', '" + ros2_type(type) + "', 'cdr', '')");
    }
    const BagBytes stored = compressed(style_.compression, message);
    sqlite3_stmt* statement = nullptr;
    sqlite3_prepare_v2(database_.get(),
                       "INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)", -1,
                       &statement, nullptr);
    sqlite3_bind_int(statement, 1, topics_[topic]);
    sqlite3_bind_int64(statement, 2, time);
    sqlite3_bind_blob64(statement, 3, stored.data(), stored.size(), SQLITE_STATIC);
    sqlite3_step(statement);
    if (sqlite3_finalize(statement) != SQLITE_OK)
      throw std::runtime_error(sqlite3_errmsg(database_.get()));
  }

  void finish() override {
    execute("COMMIT");
    database_.reset();
  }

 private:
  void execute(const std::string& sql) {
    if (sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK)
      throw std::runtime_error(sqlite3_errmsg(database_.get()));
  }

  BagStyle style_;
  std::unique_ptr<sqlite3, int (*)(sqlite3*)> database_;
  std::map<std::string, int> topics_;
};

inline std::unique_ptr<BagWriter> make_bag_writer(const std::filesystem::path& file,
                                                  const BagStyle& style) {
  if (style.format == "bag") return std::make_unique<Ros1BagWriter>(file, style);
  if (style.format == "mcap") return std::make_unique<McapWriter>(file, style);
  return std::make_unique<Ros2DatabaseWriter>(file, style);
}

}  // namespace stillpoint::testing
