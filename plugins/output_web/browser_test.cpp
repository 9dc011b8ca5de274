// The page in headless Chromium.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "output_web/fake_run.hpp"
#include "output_web/live_view_fixture.hpp"
#include "output_web/page.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint::output_web {
namespace {

namespace fs = std::filesystem;

/// Empty where there is none.
fs::path browser() {
  std::istringstream folders(std::getenv("PATH") ? std::getenv("PATH") : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    for (const char* name : {"chromium", "chromium-browser", "google-chrome"})
      if (fs::exists(fs::path(folder) / name)) return fs::path(folder) / name;
  return {};
}

std::string content_of(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

class InABrowser : public ::testing::Test {
 protected:
  void SetUp() override {
    if (page().find("<script>") == std::string_view::npos)
      GTEST_SKIP() << "built without the page: npm or esbuild are missing";
    if (browser().empty()) GTEST_SKIP() << "no chromium in PATH: apt-get install chromium";
    StageContext context = testing::test_context();
    context.output_directory = folder;
    output =
        std::make_unique<WebOutput>(WebOutput::Options{.port = 0, .record = "live.html"}, context);
    output->begin(run);
    for (std::size_t i = 0; i < recording().size(); ++i) output->frame(report_of(i));
  }

  /// The document once the expression holds, which may click; errors of its scripts fail the test.
  std::string shown(const std::string& url, const std::string& condition) const {
    const std::string command =
        "python3 '" STILLPOINT_SOURCE_DIR "/plugins/output_web/test_browser.py' '" +
        browser().string() + "' '" + url + "' \"" + condition + "\" > '" +
        (folder / "dom").string() + "' 2> '" + (folder / "log").string() + "'";
    EXPECT_EQ(std::system(command.c_str()), 0);
    EXPECT_EQ(content_of(folder / "log"), "");
    return content_of(folder / "dom");
  }

  const testing::TemporaryFolder temporary;
  const fs::path& folder = temporary.path();
  std::shared_ptr<FakeRun> run = std::make_shared<FakeRun>();
  std::unique_ptr<WebOutput> output;
};

constexpr const char* kFigures[] = {"<dt>frames</dt><dd>4</dd>", "class=\"badge tracking\"",
                                    "1 fit the pose", "<td>track</td><td class=\"number\">5.0</td>",
                                    "data-engine=\"three.js"};

TEST_F(InABrowser, TheRunIsShownAndPausedByAClick) {
  const std::string dom = shown(output->url(),
                                "document.getElementById('legend').children.length > 0 && "
                                "!document.getElementById('steering').hidden && "
                                "(!document.getElementById('paused').hidden || "
                                "(document.getElementById('pause').click(), false))");
  for (const char* figure : kFigures) EXPECT_NE(dom.find(figure), std::string::npos) << figure;
  EXPECT_NE(dom.find(">frame 3<"), std::string::npos);
  EXPECT_NE(dom.find(">Go on</button>"), std::string::npos);
  const auto calls = run->calls();
  ASSERT_FALSE(calls.empty());
  EXPECT_EQ(calls.front(), "pause");
}

TEST_F(InABrowser, ARecordingPlaysWithoutAServer) {
  output.reset();
  const std::string dom = shown("file://" + (folder / "live.html").string(),
                                "document.getElementById('replay-play').textContent == 'Play' && "
                                "document.getElementById('legend').children.length > 0");
  for (const char* figure : kFigures) EXPECT_NE(dom.find(figure), std::string::npos) << figure;
}

}  // namespace
}  // namespace stillpoint::output_web
