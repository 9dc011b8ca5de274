// Who gets in, and that nobody disturbs the others.
#include "output_web/live_view_fixture.hpp"

namespace stillpoint::output_web {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

TEST_F(LiveView, HasAPageThatLoadsNothingFromElsewhere) {
  const std::string answer = get(port(*output), "/");
  EXPECT_THAT(answer, StartsWith("HTTP/1.1 200 OK"));
  EXPECT_THAT(answer, HasSubstr("<title>Stillpoint"));
  EXPECT_THAT(answer, HasSubstr("default-src 'none'"));
  EXPECT_THAT(get(port(*output), "/index.html"), StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(answer_to(port(*output), "HEAD / HTTP/1.1\r\nHost: localhost\r\n\r\n"),
              ::testing::EndsWith("\r\n\r\n"));
  EXPECT_THAT(answer_to(port(*output), "PUT / HTTP/1.1\r\nHost: localhost\r\n\r\n"),
              StartsWith("HTTP/1.1 405"));
}

/// Noise, which JPEG makes more than a megabyte of.
FrameReport report_with_a_large_picture() {
  FrameReport report = report_of(0);
  auto frame = std::make_shared<Frame>(*report.frame);
  frame->bgr = cv::Mat(1200, 1600, CV_8UC3);
  cv::RNG(1).fill(frame->bgr, cv::RNG::UNIFORM, 0, 256);
  report.frame = std::move(frame);
  return report;
}

// The message is larger than all buffers between them: the rest of it waits in the server.
TEST_F(LiveView, ServesOthersWhileOneDoesNotRead) {
  constexpr int kSmallBuffer = 4096;  // bytes
  TestViewer hanging(port(*output), "/live", kSmallBuffer), viewer(port(*output));
  output->frame(report_with_a_large_picture());
  hanging.ask();
  const auto large = viewer.asked();
  ASSERT_TRUE(large);
  ASSERT_GT(large->at(Record::kImage).front().size(), 1'000'000u);
  for (int round = 0; round < 50; ++round) {
    FrameReport report = report_of(1);
    auto frame = std::make_shared<Frame>(*report.frame);
    frame->index = static_cast<std::uint32_t>(round);
    report.frame = frame;
    output->frame(report);
    ASSERT_TRUE(viewer.asked()) << round;
  }
  finish(*output);
  output.reset();  // does not wait for it
}

TEST_F(LiveView, StartsAnewForWhoComesAgain) {
  output->frame(report_of(0));
  for (int visit = 0; visit < 3; ++visit) {
    TestViewer viewer(port(*output));
    const auto records = viewer.asked();
    ASSERT_TRUE(records);
    EXPECT_TRUE(records->contains(Record::kRunInfo));
    EXPECT_TRUE(records->contains(Record::kFrames));
  }
}

TEST_F(LiveView, ClosesOnWhatNoPageOfItsOwnSays) {
  output->frame(report_of(0));
  constexpr auto kOther = static_cast<char>(kProtocol + 1);
  for (const std::string& wrong :
       {std::string("x"), std::string(), std::string{static_cast<char>(kProtocol), 1, '\xff'},
        std::string{kOther, 1, 7}}) {
    TestViewer viewer(port(*output));
    viewer.send(wrong);
    EXPECT_FALSE(viewer.next());
    EXPECT_EQ(viewer.close_code(), 1008) << wrong.size();
  }
  TestViewer large(port(*output));
  large.send(std::string(100, 'x'));
  EXPECT_FALSE(large.next());
  EXPECT_EQ(large.close_code(), 1009);  // too big
  EXPECT_TRUE(TestViewer(port(*output)).asked());
}

TEST_F(LiveView, BearsAFloodOfRequests) {
  output->frame(report_of(0));
  TestViewer flooding(port(*output)), viewer(port(*output));
  ASSERT_TRUE(flooding.asked(2));
  for (int round = 0; round < 1000; ++round) flooding.ask(2);  // and nothing is new
  for (std::size_t i = 1; i < recording().size(); ++i) {
    output->frame(report_of(i));
    EXPECT_TRUE(viewer.asked()) << i;
  }
  EXPECT_TRUE(flooding.next());
  output.reset();  // does not wait until all of them have been read
}

TEST_F(LiveView, SurvivesGarbage) {
  output->frame(report_of(0));
  const std::string upgrade =
      "GET /live HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
      "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";
  const std::string huge_length =
      "\x82\xff\x7f\xff\xff\xff\xff\xff\xff\xff"
      "mask";
  for (const std::string& garbage :
       {std::string("\r\n\r\n"), std::string("\0\xff\x16\x03\x01", 5) + "\r\n\r\n",
        "GET / HTTP/1.1\r\nHost: localhost\r\nX: " + std::string(100'000, 'x') + "\r\n\r\n",
        std::string("POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 99999999999\r\n\r\n"),
        std::string("GET /live HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: "
                    "Upgrade\r\n\r\n"),
        upgrade + huge_length, upgrade + "\x82\x03\x01\x01\x07"}) {  // the last one is not masked
    const std::string answer = answer_to(port(*output), garbage);
    EXPECT_THAT(answer, Not(HasSubstr("200 OK"))) << garbage.substr(0, 20);
  }
  { TestConnection silent(port(*output)); }
  EXPECT_TRUE(TestViewer(port(*output)).asked());
}

TEST_F(LiveView, RefusesPagesOfOthers) {
  EXPECT_THAT(get(port(*output), "/live",
                  "Host: localhost\r\nOrigin: http://evil.example\r\nUpgrade: websocket\r\n"
                  "Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                  "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"),
              StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(get(port(*output), "/", "Host: evil.example\r\n"), StartsWith("HTTP/1.1 403"));
}

TEST_F(LiveView, WantsTheTokenWhereThereIsOne) {
  const auto guarded = make({.port = 0, .token = "s3cret"});
  guarded->frame(report_of(0));
  EXPECT_THAT(guarded->url(), ::testing::EndsWith("/?token=s3cret"));
  EXPECT_THAT(get(port(*guarded), "/"), StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(get(port(*guarded), "/?token=s3cret"), StartsWith("HTTP/1.1 200"));
  EXPECT_THROW(TestViewer(port(*guarded), "/live?token=guess"), boost::system::system_error);
  const std::string why = get(port(*guarded), "/live?token=guess");
  EXPECT_THAT(why, StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(why, HasSubstr("the address lacks the right token"));
  EXPECT_TRUE(TestViewer(port(*guarded), "/live?token=s3cret").asked());

  const auto open = make({.port = 0, .address = "0.0.0.0"});
  EXPECT_THAT(open->url(),
              ::testing::MatchesRegex("http://0\\.0\\.0\\.0:[0-9]+/\\?token=[0-9a-f]{32}"));
  EXPECT_THAT(get(port(*open), "/"), StartsWith("HTTP/1.1 403"));
}

TEST_F(LiveView, HasAsManyViewersAsItMay) {
  const auto narrow = make({.port = 0, .viewers = 1});
  narrow->frame(report_of(0));
  TestViewer first(port(*narrow));
  ASSERT_TRUE(first.asked());
  EXPECT_THROW(TestViewer{port(*narrow)}, boost::system::system_error);
  EXPECT_THAT(get(port(*narrow), "/"), StartsWith("HTTP/1.1 200"));
  const std::string why = get(port(*narrow), "/live");  // which a page asks that was turned away
  EXPECT_THAT(why, StartsWith("HTTP/1.1 503"));
  EXPECT_THAT(why, ::testing::EndsWith("\r\n\r\nas many viewers as the run allows"));
}

std::string failure_of(const WebOutput::Options& options) {
  try {
    const WebOutput output(options, testing::test_context());
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kUsage);
    return error.what();
  }
  return "none";
}

TEST_F(LiveView, SaysWhatIsWrongWithItsOptions) {
  EXPECT_EQ(failure_of({.port = port(*output)}),
            "port: port " + std::to_string(port(*output)) +
                " is taken by another program; choose another one; 0 takes any that is free");
  EXPECT_THAT(failure_of({.port = 0, .address = "robot"}), HasSubstr("in numbers"));
  EXPECT_THAT(failure_of({.port = 0, .address = "192.0.2.1"}), HasSubstr("192.0.2.1"));
  EXPECT_THAT(failure_of({.port = 0, .token = "a b"}), HasSubstr("letters"));
}

}  // namespace
}  // namespace stillpoint::output_web
