#include "output_web/request.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "output_web/message_writer.hpp"

namespace stillpoint::output_web {
namespace {

using Bytes = std::vector<std::uint8_t>;

TEST(Request, AsksOrCommandsInThreeBytes) {
  const auto asked = parse_request(Bytes{kProtocol, 1, 5});
  ASSERT_TRUE(asked);
  const auto& request = std::get<Request>(*asked);
  EXPECT_TRUE(request.image);
  EXPECT_FALSE(request.map);
  EXPECT_TRUE(request.cloud);
  EXPECT_FALSE(request.voxels);
  EXPECT_TRUE(std::get<Request>(*parse_request(Bytes{kProtocol, 1, 8})).voxels);
  EXPECT_EQ(std::get<Command>(*parse_request(Bytes{kProtocol, 2, 1})), Command::kPause);
  EXPECT_EQ(std::get<Command>(*parse_request(Bytes{kProtocol, 2, 5})), Command::kSaveMap);
}

TEST(Request, IsNothingElse) {
  for (const Bytes& wrong :
       {Bytes{}, Bytes{kProtocol}, Bytes{kProtocol, 1}, Bytes{kProtocol, 1, 1, 0},
        Bytes{kProtocol + 1, 1, 1}, Bytes{kProtocol, 1, 16}, Bytes{kProtocol, 2, 0},
        Bytes{kProtocol, 2, 6}, Bytes{kProtocol, 3, 1}})
    EXPECT_FALSE(parse_request(wrong)) << wrong.size();
}

}  // namespace
}  // namespace stillpoint::output_web
