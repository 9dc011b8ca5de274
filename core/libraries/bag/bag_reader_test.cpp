#include "bag/bag_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "bag/mcap_file.hpp"
#include "stillpoint/support/bag_files.hpp"
#include "support/bag_writer.hpp"
#include "support/error_text.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint::bag {
namespace {

using stillpoint::testing::BagBytes;
using stillpoint::testing::BagStyle;
using stillpoint::testing::BagWriter;
using stillpoint::testing::error_text;
using stillpoint::testing::make_bag_writer;
using stillpoint::testing::TemporaryFolder;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr std::int64_t kStart = 1'305'031'102'175'304'000;  // ns
constexpr int kCount = 22;

/// Message `i`: half of them of each topic, recognisable, and larger than a page of a database.
BagBytes message(int i) {
  BagBytes bytes(5000);
  for (std::size_t k = 0; k < bytes.size(); ++k)
    bytes[k] = static_cast<std::uint8_t>(i + k * k / 7);
  return bytes;
}

std::filesystem::path write_bag(const std::filesystem::path& file, const BagStyle& style,
                                int begin = 0, int end = kCount) {
  const auto writer = make_bag_writer(file, style);
  for (int i = begin; i < end; ++i)
    writer->add(i % 2 == 0 ? "/even" : "/odd", i % 2 == 0 ? "sensor_msgs/Image" : "sensor_msgs/Imu",
                kStart + 1'000'000 * i, message(i));
  writer->finish();
  return file;
}

/// The numbers of the messages that can be read.
std::vector<int> numbers_in(BagReader& bag) {
  std::vector<int> numbers;
  for (const MessagePlace& place : bag.messages()) {
    const int i = static_cast<int>((place.time - kStart) / 1'000'000);
    try {
      const ByteSpan bytes = bag.read(place);
      EXPECT_EQ(BagBytes(bytes.begin(), bytes.end()), message(i)) << i;
      EXPECT_EQ(bag.topics().at(place.topic).name, i % 2 == 0 ? "/even" : "/odd");
      numbers.push_back(i);
    } catch (const Error&) {
    }
  }
  return numbers;
}

/// What is not checked by anything is read as it is.
std::size_t count_readable(BagReader& bag) {
  std::size_t readable = 0;
  for (const MessagePlace& place : bag.messages()) {
    try {
      bag.read(place);
      ++readable;
    } catch (const Error&) {
    }
  }
  return readable;
}

class BagReaderTest : public ::testing::TestWithParam<BagStyle> {
 protected:
  std::filesystem::path file() const { return folder_.path() / ("a." + GetParam().format); }
  TemporaryFolder folder_;
};

TEST_P(BagReaderTest, GivesEveryMessage) {
  const auto bag = open_bag(write_bag(file(), GetParam()));
  ASSERT_THAT(bag->topics(), SizeIs(2));
  EXPECT_EQ(bag->topics()[0].type, "sensor_msgs/Image");
  EXPECT_NE(bag->topics()[1].serialisation, Serialisation::kOther);
  const auto numbers = numbers_in(*bag);
  ASSERT_THAT(numbers, SizeIs(kCount));
  EXPECT_TRUE(std::ranges::is_sorted(numbers));
  if (GetParam().finished)
    EXPECT_THAT(bag->damage(), IsEmpty());
  else
    EXPECT_THAT(bag->damage(), ElementsAre(HasSubstr("was not finished")));
}

TEST_P(BagReaderTest, GivesTheBeginningOfAMessage) {
  const auto bag = open_bag(write_bag(file(), GetParam()));
  const ByteSpan bytes = bag->read(bag->messages()[3], 20);
  const BagBytes whole = message(3);
  EXPECT_EQ(BagBytes(bytes.begin(), bytes.end()), BagBytes(whole.begin(), whole.begin() + 20));
}

TEST_P(BagReaderTest, ReadsATruncatedFileAsFarAsItGoes) {
  write_bag(file(), GetParam());
  stillpoint::testing::truncate_file(file(), 0.6);
  const auto bag = open_bag(file());
  const auto numbers = numbers_in(*bag);
  EXPECT_GE(numbers.size(), 8U);
  EXPECT_LE(numbers.size(), 14U);
  for (std::size_t i = 0; i < numbers.size(); ++i) EXPECT_EQ(numbers[i], static_cast<int>(i));
  EXPECT_FALSE(bag->damage().empty());
}

TEST_P(BagReaderTest, ReadsAroundADamagedPlace) {
  write_bag(file(), GetParam());
  const auto size = static_cast<std::streamoff>(std::filesystem::file_size(file()));
  {
    std::fstream stream(file(), std::ios::in | std::ios::out | std::ios::binary);
    stream.seekp(size / 2);
    stream << std::string(GetParam().format == "db3" ? 4096 : 64, '\xff');
  }
  const auto bag = open_bag(file());
  // Without chunks, nothing says where to go on behind a record with a damaged length.
  EXPECT_GE(count_readable(*bag), GetParam().messages_in_chunk == 0 ? kCount / 2U : kCount - 8U);
}

TEST_P(BagReaderTest, JoinsTheFilesOfAFolder) {
  const std::string& ending = GetParam().format;
  write_bag(folder_.path() / ("part_10." + ending), GetParam(), 8, kCount);
  write_bag(folder_.path() / ("part_9." + ending), GetParam(), 1, 8);
  folder_.write("part_11." + ending, "");  // of a recorder that was killed
  folder_.write("metadata.yaml", "rosbag2_bagfile_information: {}\n");
  const auto bag = open_bag(folder_.path());
  ASSERT_THAT(bag->topics(), SizeIs(2));
  const auto numbers = numbers_in(*bag);
  ASSERT_THAT(numbers, SizeIs(kCount - 1));
  EXPECT_TRUE(std::ranges::is_sorted(numbers));
  EXPECT_THAT(bag->format(), HasSubstr("2 files"));
  EXPECT_THAT(bag->damage(), Contains(AllOf(HasSubstr("part_11"), HasSubstr("is empty"))));
}

std::string name_of(const ::testing::TestParamInfo<BagStyle>& parameter) {
  const BagStyle& style = parameter.param;
  return style.format + "_" + style.compression + "_" + std::to_string(style.messages_in_chunk) +
         (style.finished ? "" : "_unfinished");
}

INSTANTIATE_TEST_SUITE_P(Formats, BagReaderTest,
                         ::testing::Values(BagStyle{"bag", "none"}, BagStyle{"bag", "bz2"},
                                           BagStyle{"bag", "lz4"}, BagStyle{"bag", "none", 1},
                                           BagStyle{"bag", "lz4", 4, false},
                                           BagStyle{"mcap", "none"}, BagStyle{"mcap", "lz4"},
                                           BagStyle{"mcap", "zstd"}, BagStyle{"mcap", "none", 0},
                                           BagStyle{"mcap", "zstd", 4, false},
                                           BagStyle{"mcap", "none", 0, false},
                                           BagStyle{"db3", "none"}, BagStyle{"db3", "zstd"}),
                         name_of);

/// With an index that says where chunks are.
class IndexedBagTest : public BagReaderTest {};

// Lengths, indices, names, numbers of topics: eight bytes of 0xff, everywhere in turn.
TEST_P(IndexedBagTest, DamageAnywhereCostsTheChunksThatItIsIn) {
  write_bag(file(), GetParam());
  std::ifstream stream(file(), std::ios::binary);
  const std::string whole(std::istreambuf_iterator<char>(stream), {});
  // The header of a ROS 1 bag, of some 190 bytes, alone says where its index is.
  const std::size_t begin = GetParam().format == "bag" ? 256 : kMcapMagic.size();
  for (std::size_t at = begin; at + 8 < whole.size(); at += whole.size() / 70) {
    std::string damaged = whole;
    damaged.replace(at, 8, 8, '\xff');
    const auto bag = open_bag(folder_.write("damaged", damaged));
    EXPECT_GE(count_readable(*bag), kCount - 8U) << "damaged at byte " << at;
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, IndexedBagTest,
                         ::testing::Values(BagStyle{"bag", "none"}, BagStyle{"bag", "bz2"},
                                           BagStyle{"bag", "lz4"}, BagStyle{"mcap", "none"},
                                           BagStyle{"mcap", "lz4"}, BagStyle{"mcap", "zstd"}),
                         name_of);

std::string refusal_of(const std::filesystem::path& path) {
  return error_text(Fault::kData, [&] { open_bag(path); });
}

TEST(OpenBag, RefusesWhatIsNoBag) {
  const TemporaryFolder folder;
  EXPECT_THAT(refusal_of(folder.path() / "missing.bag"), HasSubstr("no such file"));
  EXPECT_THAT(refusal_of(folder.path()), HasSubstr("holds no bag"));
  folder.write("two/a.bag", "");
  folder.write("two/b.bag", "");
  EXPECT_THAT(refusal_of(folder.path() / "two"),
              HasSubstr("none of its bags can be read; first: "));
  EXPECT_THAT(refusal_of(folder.write("a.bag", "")), HasSubstr("is empty"));
  EXPECT_THAT(refusal_of(folder.write("a.bag", "hello")), HasSubstr("is neither a ROS 1 bag"));
  EXPECT_THAT(refusal_of(folder.write("a.bag", "#ROSBAG V1.2\n")), HasSubstr("rosbag fix"));
  EXPECT_THAT(refusal_of(folder.write("a.db3.zstd", "\x28\xb5\x2f\xfd....")), HasSubstr("zstd -d"));
}

constexpr const char* kZstd = "\x28\xb5\x2f\xfd....";

TEST(OpenBag, RefusesWhatIsCompressedAsAWholeWhereverItLies) {
  const TemporaryFolder folder;
  for (const char* name : {"walk/walk_0.mcap.zstd", "run/run_0.db3.zstd"}) {
    const auto file = folder.write(name, kZstd);
    const auto metadata = file.parent_path() / "metadata.yaml";
    EXPECT_THAT(bag_files(file), ElementsAre(file));
    for (const auto& path : {file, file.parent_path(), metadata})
      EXPECT_THAT(refusal_of(path), HasSubstr("decompress it with 'zstd -d' first")) << path;
  }
}

TEST(OpenBag, TakesTheFileThatACompressedOneWasMadeOf) {
  const TemporaryFolder folder;
  write_bag(folder.path() / "walk_0.mcap", {"mcap", "none"});
  folder.write("walk_0.mcap.zstd", kZstd);
  const auto bag = open_bag(folder.path());
  EXPECT_THAT(numbers_in(*bag), SizeIs(kCount));
  EXPECT_THAT(bag->damage(), IsEmpty());
}

TEST(OpenBag, TakesTheFolderOfItsMetadata) {
  const TemporaryFolder folder;
  write_bag(folder.path() / "walk_0.mcap", {"mcap", "none"});
  const auto metadata = folder.write("metadata.yaml", "rosbag2_bagfile_information: {}\n");
  EXPECT_EQ(bag_path(metadata), folder.path());
  EXPECT_THAT(numbers_in(*open_bag(metadata)), SizeIs(kCount));
  EXPECT_THAT(bag_files(folder.write("other/metadata.yaml", "")), IsEmpty());
}

// As `ros2 bag record --compression-mode message` writes MCAP.
TEST(OpenBag, ReadsMessagesThatAreCompressedEachForItself) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "a.mcap";
  const auto writer = make_bag_writer(file, {"mcap", "none"});
  const auto stored = [](int i) { return stillpoint::testing::compressed("zstd", message(i)); };
  for (int i = 0; i < 3; ++i)
    writer->add(i % 2 == 0 ? "/even" : "/odd", "sensor_msgs/Image", kStart + 1'000'000 * i,
                stored(i));
  BagBytes cut = stored(3);
  cut.resize(cut.size() / 2);
  writer->add("/odd", "sensor_msgs/Image", kStart + 3'000'000, cut);
  writer->finish();
  const auto bag = open_bag(file);
  EXPECT_THAT(numbers_in(*bag), ElementsAre(0, 1, 2));
  const ByteSpan begin = bag->read(bag->messages()[1], 20);
  const BagBytes whole = message(1);
  EXPECT_EQ(BagBytes(begin.begin(), begin.end()), BagBytes(whole.begin(), whole.begin() + 20));
  EXPECT_THAT(error_text(Fault::kData, [&] { bag->read(bag->messages()[3]); }),
              HasSubstr("a.mcap: the compressed message is damaged: it ends too early"));
}

TEST(OpenBag, RefusesOtherDatabases) {
  const TemporaryFolder folder;
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open((folder.path() / "a.db3").c_str(), &database), SQLITE_OK);
  sqlite3_exec(database, "CREATE TABLE people(name)", nullptr, nullptr, nullptr);
  sqlite3_close(database);
  EXPECT_THAT(refusal_of(folder.path() / "a.db3"), HasSubstr("is no bag of ROS 2: no such table"));
}

TEST(OpenBag, RunsNoSqlOfTheFile) {
  const TemporaryFolder folder;
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open((folder.path() / "a.db3").c_str(), &database), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(database,
                         "CREATE VIEW topics AS WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT "
                         "i + 1 FROM n) SELECT i AS id, '' AS name, '' AS type, '' AS "
                         "serialization_format FROM n",
                         nullptr, nullptr, nullptr),
            SQLITE_OK);
  sqlite3_close(database);
  EXPECT_THAT(refusal_of(folder.path() / "a.db3"), HasSubstr("is no bag of ROS 2"));
}

// The sizes of a chunk and of a message are numbers that anybody can write.
TEST(OpenBag, AllocatesNothingForSizesThatAreStatedOnly) {
  const TemporaryFolder folder;
  const auto file = write_bag(folder.path() / "a.mcap", {"mcap", "zstd"});
  std::filesystem::resize_file(file, 20ULL << 30);  // sparse
  const auto bag = open_bag(file);
  EXPECT_THAT(numbers_in(*bag), SizeIs(kCount));
}

TEST(ReadSeconds, AreTheNearestNumbers) {
  EXPECT_EQ(seconds(kStart), 1305031102.175304);
  EXPECT_EQ(seconds(1'700'000'000'000'000'001), 1700000000.000000001);
}

}  // namespace
}  // namespace stillpoint::bag
