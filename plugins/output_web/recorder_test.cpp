#include "output_web/recorder.hpp"

#include <filesystem>
#include <fstream>
#include <stillpoint/support/base64.hpp>

#include "output_web/live_view_fixture.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint::output_web {
namespace {

namespace fs = std::filesystem;

class Recording : public ::testing::Test {
 protected:
  std::unique_ptr<WebOutput> output(const std::string& name) const {
    StageContext context = testing::test_context();
    context.output_directory = folder;
    return std::make_unique<WebOutput>(WebOutput::Options{.port = 0, .record = name}, context);
  }
  std::string text() const {
    std::ifstream stream(folder / "live.html");
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  const testing::TemporaryFolder temporary;
  const fs::path& folder = temporary.path();
};

// Of a page, so that a message is found as it is.
std::string within_page(const std::string& message) {
  return "<script type=\"text/plain\" class=\"message\">" + base64(message) + "</script>\n";
}

TEST_F(Recording, IsThePageAndWhatAViewerGets) {
  EventLog events({.name = "walk", .classes = testing::TestRecording::classes(), .truth = {}});
  Recorder recorder(folder / "live.html", "<page>");
  std::string expected = "<page>\n";
  Seen seen;
  const auto take = [&](bool image) {
    recorder.take(events);
    expected += within_page(
        events.news(seen, {.image = image, .map = true, .cloud = true, .voxels = true}));
  };
  events.set_steering("{}");
  take(true);  // there is no image yet
  for (std::size_t i = 0; i < 4; ++i) {
    events.add(report_of(i));
    take(i % 3 == 0);
  }
  recorder.take(events);  // nothing is new
  recorder.finish(events);
  EXPECT_EQ(text().substr(0, expected.size()), expected);
}

TEST_F(Recording, OfAnEarlierRunStaysUntilTheFirstFrame) {
  std::ofstream(folder / "live.html") << "<earlier>";
  EventLog events({.name = "walk", .classes = testing::TestRecording::classes(), .truth = {}});
  Recorder recorder(folder / "live.html", "<page>");
  const Recorder other(folder / "other.html", "<page>");
  EXPECT_FALSE(fs::exists(folder / "other.html"));
  events.set_steering("{}");
  recorder.take(events);
  EXPECT_EQ(text(), "<earlier>");
  events.add(report_of(0));
  recorder.take(events);
  EXPECT_THAT(text(), ::testing::StartsWith("<page>\n<script"));
}

TEST_F(Recording, IsWholeWithoutAnybodyLooking) {
  auto live = output("live.html");
  for (std::size_t i = 0; i < recording().size(); ++i) live->frame(report_of(i));
  live.reset();
  const std::string page = text();
  EXPECT_THAT(page, ::testing::HasSubstr("<title>Stillpoint"));
  EXPECT_THAT(page, ::testing::EndsWith("</script>\n"));
  EXPECT_THAT(page, ::testing::HasSubstr("class=\"message\""));
}

TEST_F(Recording, SaysWhichFileCannotBeWritten) {
  try {
    output("no/folder/live.html");
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("no/folder/live.html cannot be written"));
    EXPECT_EQ(error.fault(), Fault::kUsage);
  }
}

}  // namespace
}  // namespace stillpoint::output_web
