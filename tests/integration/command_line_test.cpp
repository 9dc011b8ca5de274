// What the command line says about itself, and how little it says when it is to be quiet.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "support/simulated_recording.hpp"

namespace stillpoint::testing {
namespace {

using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::Contains;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::Eq;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::MatchesRegex;
using ::testing::Not;
using ::testing::StartsWith;

std::vector<std::string> completions(std::vector<std::string> words) {
  words.insert(words.begin(), "--complete");
  const Outcome outcome = call(std::move(words));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  std::vector<std::string> candidates;
  std::istringstream lines(outcome.out);
  for (std::string line; std::getline(lines, line);)
    candidates.push_back(line.substr(0, line.find('\t')));
  return candidates;
}

TEST(CommandLine, SaysItsVersionAndAllExitCodes) {
  EXPECT_THAT(call({"-V"}).out,
              MatchesRegex("stillpoint 0\\.[0-9.]+( \\(commit [0-9a-f]+(-dirty)?\\))?\n"));
  EXPECT_EQ(call({"-V"}).out, call({"--version"}).out);
  for (const char* code : {"0 done", "1 a stage failed", "2 wrong usage", "3 unusable data", "130"})
    EXPECT_THAT(call({"run", "--help"}).out, HasSubstr(code));
}

TEST(CommandLine, CheckWarnsOfStagesThatNothingUses) {
  const Outcome outcome = call({"check", "orb_baseline", "--set", "segmenter=person"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.err,
              HasSubstr("there is no decision, so that tracking does not use: segmenter"));
}

TEST(CommandLine, OptionsThatDoNotExistGetASuggestion) {
  const auto refusal = [](std::vector<std::string> words) {
    const Outcome outcome = call(std::move(words));
    EXPECT_EQ(outcome.exit_code, 2);
    return outcome.err;
  };
  EXPECT_THAT(refusal({"run", "orb_baseline", "--datset", "x"}),
              Eq("error: stillpoint run: no option '--datset'; did you mean '--dataset'?\n"));
  EXPECT_THAT(refusal({"run", "--outptu=x"}), HasSubstr("did you mean '--output'?"));
  EXPECT_THAT(refusal({"--quiet", "run", "orb_baseline"}),
              Eq("error: stillpoint run: option '--quiet' stands before the command; write "
                 "'stillpoint run --quiet'\n"));
  EXPECT_THAT(refusal({"run", "orb_baseline", "--dataset"}),
              Not(HasSubstr("stands before the command")));
  EXPECT_THAT(refusal({"plugins", "list", "--jsno"}),
              HasSubstr("stillpoint plugins list: no option '--jsno'; did you mean '--json'?"));
  EXPECT_THAT(refusal({"run", "orb_baseline", "-x"}),
              HasSubstr("no option '-x'; 'stillpoint run --help' lists them"));
  EXPECT_THAT(refusal({"run", "stillpoint", "walk"}),
              HasSubstr("'walk' was not expected; a recording is given as '--dataset walk'"));
  EXPECT_THAT(refusal({"run", "stillpoint", "--view", "9000"}),
              HasSubstr("'9000' was not expected; a port is given as '--view=9000'"));
  EXPECT_THAT(refusal({"run"}), HasSubstr("Run 'stillpoint run --help' for help."));
}

TEST(Completion, OfCommandsAndOptions) {
  EXPECT_THAT(completions({"r"}), ElementsAre("record", "report", "run"));
  EXPECT_THAT(completions({"plugins", ""}), AllOf(Contains("list"), Contains("new")));
  EXPECT_THAT(completions({"run", "--s"}), ElementsAre("--set", "--save-map"));
  EXPECT_THAT(completions({}), AllOf(Contains("run"), Contains("simulate"), Not(Contains("list"))));
}

TEST(Completion, OfValues) {
  EXPECT_THAT(completions({"run", "st"}), Contains("stillpoint"));
  EXPECT_THAT(completions({"run", "stillpoint", "--camera", "tum"}),
              AllOf(Contains("tum_fr3"), Contains("<files>")));
  EXPECT_THAT(completions({"run", "stillpoint", "--dataset", ""}), ElementsAre("<files>"));
  EXPECT_THAT(completions({"run", "stillpoint", "--load-map", ""}), ElementsAre("<files>"));
  EXPECT_THAT(completions({"run", "--dataset", "x", "orb_b"}), Contains("orb_baseline"));
  EXPECT_THAT(completions({"plugins", "new", "map_"}), ElementsAre("map_checker", "map_backend"));
  EXPECT_THAT(completions({"map", "render", "m.ot", "--mode", "c"}), ElementsAre("color", "class"));
  EXPECT_THAT(completions({"run", "stillpoint", "too_much"}), IsEmpty());
  EXPECT_THAT(completions({"simulate", "fr3_walking_x"}),
              Each(AnyOf(StartsWith("fr3_walking_x"), StartsWith("<"))));
}

/// What bash offers after `stillpoint LINE`, whose words it cuts at '='.
std::vector<std::string> offered_by_bash(const std::string& line) {
  const std::string script =
      std::string(STILLPOINT_SOURCE_DIR) + "/tools/stillpoint/completion/stillpoint.bash";
  const Outcome outcome =
      call({"-c",
            "source \"$1\"; COMP_LINE=\"stillpoint $2\"; COMP_POINT=${#COMP_LINE}\n"
            "COMP_WORDS=(\"$0\" ${2//=/ = }); [[ $2 == *' ' ]] && COMP_WORDS+=('')\n"
            "COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); compopt() { :; }\n"
            "_stillpoint; printf '%s\\n' \"${COMPREPLY[@]}\"",
            program_file(), script, line},
           {.program = "/bin/bash"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  std::vector<std::string> words;
  std::istringstream lines(outcome.out);
  for (std::string word; std::getline(lines, word);) words.push_back(word);
  return words;
}

TEST(Completion, InBash) {
  EXPECT_THAT(offered_by_bash("r"), ElementsAre("record", "report", "run"));
  EXPECT_THAT(offered_by_bash("plugins "), Contains("describe"));
  EXPECT_THAT(offered_by_bash("run --set a=b orb_b"), Contains("orb_baseline"));
  EXPECT_THAT(offered_by_bash("run --set a=\\'b=c\\' --dataset=x orb_b"), Contains("orb_baseline"));
  EXPECT_THAT(offered_by_bash("run orb_baseline --camera=tum_fr3"), Contains("tum_fr3"));
  EXPECT_THAT(offered_by_bash("map render " STILLPOINT_SOURCE_DIR "/READ"),
              ElementsAre(STILLPOINT_SOURCE_DIR "/README.md"));
}

/// Types `stillpoint LINE` and two tabs into zsh, and waits for `expected`; the screen.
std::string completed_by_zsh(const std::string& line, const std::string& expected) {
  const std::string script = R"(zmodload zsh/zpty
zpty shell zsh -f -i
zpty -w shell "PS1= ; path=('$1' \$path); fpath=('$2' \$fpath); autoload -Uz compinit; compinit -u -D; print re''ady"
zpty -r shell screen '*ready*'
zpty -w -n shell "stillpoint $3"$'\t\t'
zpty -r shell screen "*$4*"
print -r -- $screen)";
  return call({"30", "zsh", "-f", "-c", script, "zsh", program_file().parent_path().string(),
               STILLPOINT_SOURCE_DIR "/tools/stillpoint/completion", line, expected},
              {.program = "/usr/bin/timeout"})
      .out;
}

TEST(Completion, InZsh) {
  if (!std::filesystem::exists("/usr/bin/zsh")) GTEST_SKIP() << "zsh is not installed";
  EXPECT_THAT(completed_by_zsh("run --dat", "--dataset"), HasSubstr("--dataset"));
  EXPECT_THAT(completed_by_zsh("run x --camera tum_", "tum_fr3"), HasSubstr("tum_fr1"));
  EXPECT_THAT(completed_by_zsh("run x --camera=tum_", "tum_fr3"), HasSubstr("tum_fr1"));
}

class CommandLineRun : public ::testing::Test {
 protected:
  Outcome run(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(),
                     {"run", "orb_baseline", "-o", out().string(), "--dataset",
                      simulated_recording().string(), "--set", "runtime.mode=inline"});
    return call(std::move(arguments));
  }
  std::filesystem::path out() const { return folder_.path() / "out"; }

 private:
  TemporaryFolder folder_;
};

TEST_F(CommandLineRun, QuietPrintsNothing) {
  for (const char* word : {"-q", "--quiet"}) {  // the second overwrites the first
    const Outcome outcome = run({word});
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(outcome.err, "");
  }
  EXPECT_EQ(count_poses(out() / "trajectory.txt"), kSimulatedFrames);
}

TEST_F(CommandLineRun, QuietStillPrintsErrors) {
  const Outcome outcome = run({"-q", "--set", "tracker.features=-1"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("features"));
}

TEST_F(CommandLineRun, OutputsCanBeAdded) {
  ASSERT_EQ(run({"--images", "--with", "trajectory"}).exit_code, 0);  // the file has the second
  EXPECT_EQ(count_poses(out() / "trajectory.txt"), kSimulatedFrames);
  EXPECT_FALSE(std::filesystem::is_empty(out() / "images"));
  EXPECT_THAT(text_of(out() / "pipeline.yaml"), HasSubstr("type: images"));
  const Outcome wrong = run({"--with", "imags"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.err, AllOf(HasSubstr("--with imags"), HasSubstr("did you mean 'images'?")));
}

TEST_F(CommandLineRun, OptionsOfOutputsCanBeSet) {
  ASSERT_EQ(run({"--with", "images.every=50", "--with", "images.folder=seen", "--with",
                 "trajectory.file=path.txt"})
                .exit_code,
            0);
  EXPECT_EQ(count_poses(out() / "path.txt"), kSimulatedFrames);
  EXPECT_FALSE(std::filesystem::exists(out() / "trajectory.txt"));
  const std::filesystem::directory_iterator pictures(out() / "seen");
  EXPECT_EQ(std::distance(begin(pictures), end(pictures)), (kSimulatedFrames + 49) / 50);
  const Outcome wrong = run({"--with", "images.evry=50"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.err,
              AllOf(HasSubstr("--with images.evry=50"), HasSubstr("did you mean 'every'?")));
}

TEST_F(CommandLineRun, ViewTellsWhereToLook) {
  const Outcome outcome = run({"--view=0"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.err, HasSubstr("live view at http://127.0.0.1:"));
  const Outcome wrong = run({"--view=70000"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("65535"));
}

}  // namespace
}  // namespace stillpoint::testing
