// The page in headless Chromium.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "output_web/live_view_fixture.hpp"
#include "output_web/page.hpp"

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

std::string text_of(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST_F(LiveView, IsShownByABrowser) {
  if (page().find("<script>") == std::string_view::npos)
    GTEST_SKIP() << "built without the page: npm or esbuild are missing";
  if (browser().empty()) GTEST_SKIP() << "no chromium in PATH: apt-get install chromium";
  const fs::path folder = fs::path(::testing::TempDir()) / "output_web_browser";
  fs::remove_all(folder);
  fs::create_directories(folder);
  for (std::size_t i = 0; i < recording().size(); ++i) output->frame(report_of(i));
  const std::string command =
      "python3 '" STILLPOINT_SOURCE_DIR "/plugins/output_web/test_browser.py' '" +
      browser().string() + "' '" + output->url() + "' " +
      "\"document.getElementById('legend').children.length > 0\" > '" + (folder / "dom").string() +
      "' 2> '" + (folder / "log").string() + "'";
  ASSERT_EQ(std::system(command.c_str()), 0) << text_of(folder / "log");
  const std::string dom = text_of(folder / "dom");
  for (const char* shown :
       {"<dt>frames</dt><dd>4</dd>", "class=\"badge tracking\"", "1 fit the pose", ">frame 3<",
        "<td>track</td><td class=\"number\">5.0</td>", "data-engine=\"three.js"})
    EXPECT_NE(dom.find(shown), std::string::npos) << shown;
  EXPECT_EQ(text_of(folder / "log"), "");
  fs::remove_all(folder);
}

}  // namespace
}  // namespace stillpoint::output_web
