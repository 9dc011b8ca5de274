#include "bag/compression.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/bag_writer.hpp"

namespace stillpoint::bag {
namespace {

class CompressionTest : public ::testing::TestWithParam<const char*> {
 protected:
  CompressionTest() : plain_(300'000) {
    for (std::size_t i = 0; i < plain_.size(); ++i)
      plain_[i] = static_cast<std::uint8_t>(i * i / 1000 + i % 7);
    stored_ = stillpoint::testing::compressed(GetParam(), plain_);
  }
  Decompressed undo(ByteSpan bytes, std::size_t most) const {
    return decompress(*compression_named(GetParam()), bytes, most);
  }
  std::vector<std::uint8_t> plain_, stored_;
};

TEST_P(CompressionTest, IsUndone) {
  const Decompressed result = undo(stored_, plain_.size());
  EXPECT_EQ(result.bytes, plain_);
  EXPECT_EQ(result.fault, "");
}

TEST_P(CompressionTest, GivesNoMoreThanAsked) {
  const Decompressed result = undo(stored_, 1000);
  EXPECT_EQ(result.bytes.size(), 1000U);
  EXPECT_EQ(result.fault, "it holds more than it says");
}

TEST_P(CompressionTest, IsUndoneAsFarAsItGoes) {
  const Decompressed result = undo(ByteSpan(stored_).first(stored_.size() * 2 / 3), 1 << 30);
  EXPECT_EQ(result.fault, "it ends too early");
  EXPECT_TRUE(std::equal(result.bytes.begin(), result.bytes.end(), plain_.begin()));
}

TEST_P(CompressionTest, OfOtherBytesIsDamaged) {
  const std::vector<std::uint8_t> noise(100, 0x5a);
  const Decompressed result = undo(noise, 1 << 30);
  EXPECT_THAT(result.fault, ::testing::HasSubstr("damaged"));
  EXPECT_TRUE(result.bytes.empty());
}

INSTANTIATE_TEST_SUITE_P(Kinds, CompressionTest, ::testing::Values("bz2", "lz4", "zstd"));

TEST(Compression, HasKnownNames) {
  EXPECT_EQ(compression_named(""), Compression::kNone);
  EXPECT_EQ(compression_named("none"), Compression::kNone);
  EXPECT_EQ(compression_named("lzma"), std::nullopt);
}

}  // namespace
}  // namespace stillpoint::bag
