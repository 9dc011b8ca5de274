#include "output_web/access.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace stillpoint::output_web {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

TEST(Access, OfThisMachineAloneNeedsItsNames) {
  const Access access("127.0.0.1", "");
  for (const char* host :
       {"localhost", "localhost:8080", "127.0.0.1:9999", "[::1]:80", "127.1.2.3"})
    EXPECT_THAT(access.refusal({.target = "/", .host = host}), IsEmpty()) << host;
  for (const char* host : {"", "evil.example", "evil.example:8080", "localhost.evil.example", "[",
                           "192.168.1.2:8080", "127.0.0.1.evil.example"})
    EXPECT_THAT(access.refusal({.target = "/", .host = host}), Not(IsEmpty())) << host;
}

TEST(Access, IsForPagesOfTheServerItself) {
  const Access access("127.0.0.1", "");
  const auto refusal = [&](const char* origin) {
    return access.refusal({.target = "/live", .host = "localhost:9000", .origin = origin});
  };
  EXPECT_THAT(refusal("http://localhost:9000"), IsEmpty());
  EXPECT_THAT(refusal("https://localhost:9000"), IsEmpty());  // behind a proxy
  for (const char* origin : {"http://evil.example", "http://localhost:9001", "http://localhost",
                             "null", "file://", "http://localhost:9000.evil.example"})
    EXPECT_THAT(refusal(origin), HasSubstr("other sites")) << origin;
}

TEST(Access, FromElsewhereNeedsTheToken) {
  const Access access("0.0.0.0", "s3cret");
  const auto refusal = [&](const char* target) {
    return access.refusal({.target = target, .host = "robot:8080"});
  };
  for (const char* target : {"/?token=s3cret", "/live?a=b&token=s3cret", "/?token=s3cret&x"})
    EXPECT_THAT(refusal(target), IsEmpty()) << target;
  for (const char* target : {"/", "/?", "/?token=", "/?token=s3cre", "/?token=s3cretx", "/?&&token",
                             "/?xtoken=s3cret", "/s3cret"})
    EXPECT_THAT(refusal(target), HasSubstr("token")) << target;
}

TEST(Access, TokensAreLongAndDiffer) {
  EXPECT_THAT(random_token(), ::testing::SizeIs(32));
  EXPECT_NE(random_token(), random_token());
}

}  // namespace
}  // namespace stillpoint::output_web
