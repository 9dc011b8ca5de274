// Bags of ROS 1, by the description (https://wiki.ros.org/Bags/Format/2.0).
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "support/bag_style.hpp"

namespace stillpoint::testing {

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

}  // namespace stillpoint::testing
