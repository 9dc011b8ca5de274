// The page in headless Chromium.
#include <filesystem>
#include <fstream>
#include <iterator>

#include "output_web/fake_run.hpp"
#include "output_web/live_view_fixture.hpp"
#include "output_web/page.hpp"
#include "support/browser.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint::output_web {
namespace {

namespace fs = std::filesystem;
using testing::document_in_browser;

class InABrowser : public ::testing::Test {
 protected:
  void SetUp() override {
    if (page().find("<script>") == std::string_view::npos)
      GTEST_SKIP() << "built without the page: npm or esbuild are missing";
    SKIP_WITHOUT_BROWSER();
    StageContext context = testing::test_context();
    context.output_directory = folder;
    run->dense = {{.position = {0, 0, 1}}};
    output =
        std::make_unique<WebOutput>(WebOutput::Options{.port = 0, .record = "live.html"}, context);
    output->begin(run);
    for (std::size_t i = 0; i < recording().size(); ++i) output->frame(report_of(i));
  }

  const testing::TemporaryFolder temporary;
  const fs::path& folder = temporary.path();
  std::shared_ptr<FakeRun> run = std::make_shared<FakeRun>();
  std::unique_ptr<WebOutput> output;
};

constexpr const char* kFigures[] = {"<dt>frames</dt><dd>4</dd>",
                                    "<dt>left out by the source</dt><dd>6</dd>",
                                    "class=\"badge tracking\"",
                                    "1 fit the pose",
                                    "<td>track</td><td class=\"number\">5.0</td>",
                                    "data-engine=\"three.js"};

TEST_F(InABrowser, TheRunIsShownAndPausedByAClick) {
  const std::string dom =
      document_in_browser(output->url(),
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

// A second after the page is there, it has asked for what is new, and nothing is.
constexpr const char* kChooseDenseMap = R"((() => {
  const byId = (id) => document.getElementById(id);
  const kinds = (message) => {
    const view = new DataView(message), found = [];
    for (let at = 1; at < view.byteLength; at += 5 + view.getUint32(at + 1, true))
      found.push(view.getUint8(at));
    return found;
  };
  if (byId('legend').children.length === 0) return false;
  window.since ??= performance.now();
  if (performance.now() - window.since < 1000) return false;
  if (!window.realSend) {
    window.realSend = WebSocket.prototype.send;
    WebSocket.prototype.send = function(bytes) {
      const look = ({data}) => { window.voxels ||= kinds(data).includes(16); };
      this.addEventListener('message', look, {once: true});
      realSend.call(this, bytes);
    };
    byId('surfaces').value = 'voxels';
    byId('surfaces').dispatchEvent(new Event('change'));
  }
  return window.voxels;
})())";

TEST_F(InABrowser, TheDenseMapComesWhenItIsChosenThoughNothingElseIsNew) {
  document_in_browser(output->url(), kChooseDenseMap);
}

TEST_F(InABrowser, APageThatIsNotLetInSaysWhy) {
  const WebOutput guarded({.port = 0, .token = "s3cret", .viewers = 1}, testing::test_context());
  const TestViewer first(port_of(guarded.url()), "/live?token=s3cret");
  document_in_browser(guarded.url(), R"((() => {
    const said = document.getElementById('connection').textContent;
    if (said === 'as many viewers as the run allows')
      history.replaceState(null, '', '?token=guess');
    return said.startsWith('the address lacks the right token');
  })())");
}

TEST_F(InABrowser, ARecordingPlaysWithoutAServer) {
  output.reset();
  const std::string dom =
      document_in_browser("file://" + (folder / "live.html").string(),
                          "document.getElementById('replay-play').textContent == 'Play' && "
                          "document.getElementById('legend').children.length > 0");
  for (const char* figure : kFigures) EXPECT_NE(dom.find(figure), std::string::npos) << figure;
}

// Of a process that was killed while it wrote: of 101 letters of base64, the last is no whole byte;
// 100 end within a record.
TEST_F(InABrowser, OfARecordingThatIsCutOffTheRestPlays) {
  output.reset();
  std::ifstream stream(folder / "live.html");
  const std::string whole(std::istreambuf_iterator<char>(stream), {});
  const std::string begin = "<script type=\"text/plain\" class=\"message\">";
  const std::size_t message = whole.find(begin);
  ASSERT_NE(message, std::string::npos);
  for (const std::size_t letters : {100u, 101u}) {
    const fs::path file =
        temporary.write("cut_" + std::to_string(letters) + ".html",
                        whole + begin + whole.substr(message + begin.size(), letters));
    const std::string dom = document_in_browser(
        "file://" + file.string(),
        "document.getElementById('replay-play').textContent == 'Play' && "
        "document.getElementById('connection').textContent == 'the recording ends early' && "
        "document.getElementById('legend').children.length > 0");
    for (const char* figure : kFigures) EXPECT_NE(dom.find(figure), std::string::npos) << figure;
  }
}

// As the page of another version does, which does not know the number of this protocol.
TEST_F(InABrowser, APageOfAnotherVersionAsksToBeReloaded) {
  document_in_browser(
      output->url(),
      "document.getElementById('connection').textContent.endsWith('reload it') || "
      "(window.realSend = window.realSend || WebSocket.prototype.send, "
      "WebSocket.prototype.send = function(bytes) { bytes[0] = 99; realSend.call(this, bytes); }, "
      "document.getElementById('steering').hidden || document.getElementById('pause').click(), "
      "false)");
  EXPECT_TRUE(run->calls().empty());
}

}  // namespace
}  // namespace stillpoint::output_web
