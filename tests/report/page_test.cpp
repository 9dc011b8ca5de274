// The page of `stillpoint report` in a browser.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "finished_run.hpp"
#include "study/cell_result.hpp"
#include "support/browser.hpp"

namespace stillpoint::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr int kRooms = 8;

/// On each of the sequences room_0, room_1, … `better` has a fifth of the error of `plain`.
void write_finished_study(const TemporaryFolder& folder) {
  std::string sequences;
  for (int room = 0; room < kRooms; ++room) {
    const std::string name = "room_" + std::to_string(room);
    sequences += "  - {name: " + name + ", dataset: /none/" + name + "}\n";
    for (const auto& [variant, error] : {std::pair{"plain", 0.1}, {"better", 0.02}}) {
      study::CellResult result{
          .fingerprint = "f",
          .program = "p",
          .origin = {"1.2.3", "0123456789ab", "a machine, 2 cores", "2026-01-30"}};
      result.values[study::kAte] = error + 0.001 * room;
      result.values[study::kCoverage] = 100.0;
      const fs::path run = folder.path() / "runs" / name / variant / "0";
      fs::create_directories(run);
      study::write_result(run, result);
    }
  }
  folder.write("study.yaml", "version: 1\nquestion: Is it better?\nsequences:\n" + sequences +
                                 "variants:\n  - {name: plain, pipeline: orb_baseline}\n"
                                 "  - {name: better, pipeline: stillpoint}\nbaseline: plain\n");
}

/// What probe.js has seen in the page.
nlohmann::json probed(const fs::path& page, const TemporaryFolder& folder) {
  std::string text = text_of(page);
  const std::string script =
      "<script>" + text_of(fs::path(STILLPOINT_SOURCE_DIR) / "tests/report/probe.js") + "</script>";
  text.insert(text.rfind("</body>"), script);
  const fs::path probe = folder.write("probe.html", text);
  const std::string result =
      document_in_browser("file://" + probe.string(), "document.getElementById('probe') !== null");
  const std::string begin = "<pre id=\"probe\">";
  const std::size_t from = result.find(begin);
  if (from == std::string::npos) return {{"ready", "never"}};
  const std::size_t to = result.find("</pre>", from);
  return nlohmann::json::parse(result.substr(from + begin.size(), to - from - begin.size()));
}

TEST(ReportPage, DrawsSortsAndTurnsInABrowser) {
  SKIP_WITHOUT_PAGE();
  SKIP_WITHOUT_BROWSER();
  const TemporaryFolder folder;
  const fs::path page = folder.path() / "report.html";
  const Outcome outcome = call({"report", finished_run().string(), "-o", page.string()});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json seen = probed(page, folder);
  ASSERT_EQ(seen["ready"], "yes") << seen;
  EXPECT_EQ(seen["errors"], nlohmann::json::array());
  EXPECT_EQ(seen.value("command", ""),
            "stillpoint report '" + finished_run().string() + "' -o " + page.string());
  EXPECT_EQ(seen["charts"], 5);  // ATE, RPE, excluded pixels, features, stages
  EXPECT_GT(seen["lines"], 4);
  EXPECT_GT(seen["pictures"], 1);
  const auto rising = seen["rising"].get<std::vector<double>>();
  EXPECT_TRUE(std::ranges::is_sorted(rising));
  EXPECT_EQ(std::vector<double>(rising.rbegin(), rising.rend()),
            seen["falling"].get<std::vector<double>>());
  EXPECT_EQ(seen["turned"], true);
  EXPECT_EQ(seen["repainted"], true);
  EXPECT_EQ(seen["replayed"], true);
}

TEST(ReportPage, ShowsAStudyAndOpensItsRunsInABrowser) {
  SKIP_WITHOUT_PAGE();
  SKIP_WITHOUT_BROWSER();
  const TemporaryFolder folder;
  write_finished_study(folder);
  const Outcome outcome = call({"report", folder.path().string()});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::string shown =
      document_in_browser("file://" + (folder.path() / "report.html").string(), R"((() => {
        if (document.documentElement.dataset.ready !== 'yes') return false;
        const wanted = 'room_3/better/0';
        const names = [...document.querySelectorAll('tbody th a')];
        names.find(name => name.textContent === wanted).click();
        return document.getElementById('run').selectedOptions[0].textContent === wanted;
      })())");
  EXPECT_THAT(shown, AllOf(HasSubstr("Is it better?"), HasSubstr("commit 0123456789ab"),
                           HasSubstr("Compared with plain"), HasSubstr("0.0078")));
  const auto count = [&](const std::string& text) {
    int found = 0;
    for (std::size_t at = 0; (at = shown.find(text, at)) != std::string::npos; ++at) ++found;
    return found;
  };
  EXPECT_EQ(count("<td class=\"best\">0.02"), kRooms);
  EXPECT_GT(count("significant"), 0);
}

}  // namespace
}  // namespace stillpoint::testing
