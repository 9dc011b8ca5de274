// MCAP files, by the specification (https://mcap.dev/spec). The library ros2_messages, whose files
// are read in tests/integration/record_test.cpp, writes the one kind of file that is best: here are
// those without chunks, without an index or an end, and with messages of any type, as others leave
// them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "support/bag_style.hpp"

namespace stillpoint::testing {

class McapBagWriter final : public BagWriter {
 public:
  McapBagWriter(std::filesystem::path file, BagStyle style)
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

}  // namespace stillpoint::testing
