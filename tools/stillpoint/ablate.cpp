// stillpoint ablate: a matrix of runs, and the tables of what came out.
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "commands.hpp"
#include "commit.hpp"
#include "console.hpp"
#include "evaluation/format.hpp"
#include "evaluation/trajectory.hpp"
#include "interrupt.hpp"
#include "shell_word.hpp"
#include "stillpoint/engine/folder_lock.hpp"
#include "stillpoint/error.hpp"
#include "stillpoint/support/did_you_mean.hpp"
#include "study/cell_folder.hpp"
#include "study/cell_runner.hpp"
#include "study/child_process.hpp"
#include "study/claim.hpp"
#include "study/csv_report.hpp"
#include "study/fingerprint.hpp"
#include "study/latex_report.hpp"
#include "study/markdown_report.hpp"
#include "study/recordings.hpp"
#include "study/slurm_batch.hpp"
#include "study/slurm_queue.hpp"
#include "study/slurm_runner.hpp"
#include "study/text_file.hpp"
#include "study_file.hpp"
#include "study_list.hpp"
#include "study_plan.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;
using namespace study;
using evaluation::fixed;

constexpr const char* kReplaceHint =
    "choose another folder with -o, or add --again to replace them";

struct AblateArguments {
  std::string study;
  fs::path output;
  int jobs = 1;
  std::string executor = "local";
  bool again = false;
  bool quiet = false;
  bool list = false;
};

/// With all that results and times depend on.
std::string command_of(const AblateArguments& arguments) {
  std::string command = "stillpoint ablate " + shell_word(arguments.study);
  if (!arguments.output.empty()) command += " -o " + shell_word(arguments.output.string());
  if (arguments.executor != "local") return command + " --executor " + arguments.executor;
  if (arguments.jobs > 1) command += " -j " + std::to_string(arguments.jobs);
  return command;
}

/// One call of `stillpoint ablate`.
class Ablation {
 public:
  explicit Ablation(const AblateArguments& arguments)
      : command_(command_of(arguments)),
        file_(load_study(arguments.study, registry_)),
        output_(fs::absolute(arguments.output.empty() ? fs::path("out") / file_.file.stem()
                                                      : arguments.output)
                    .lexically_normal()),
        jobs_(arguments.jobs),
        with_slurm_(arguments.executor == "slurm"),
        again_(arguments.again),
        quiet_(arguments.quiet),
        console_(arguments.quiet) {}

  /// Throws Error when runs have failed, after everything has been written.
  void run() {
    make_folder(output_);
    const FolderLock lock(output_);
    claim_folder(output_, file_.file, command_);
    int signal = 0;
    {
      const Interrupt interrupt([this](const std::string& line) { console_.line(line); });
      const std::optional<StudyResults> results = run_cells(interrupt.token());
      if (results) write(*results);
      signal = Interrupt::signal();
      if (signal == 0) return throw_if_failed(*results);
    }
    say_how_it_goes_on();
    std::raise(signal);  // so that a calling script sees that it was interrupted
  }

 private:
  const Study& study() const { return file_.study; }

  /// Nothing when it was stopped before the first run: what is there stays that of the last call.
  std::optional<StudyResults> run_cells(const std::stop_token& stop) {
    StudyResults results{
        .study = study(), .cells = cells_of(study()), .results = {}, .command = command_};
    results.results.resize(results.cells.size());
    if (with_slurm_) ask_slurm();
    if (!record_scenes(stop)) return std::nullopt;
    const std::vector<PlannedCell> plan = plan_cells(study(), results.cells, output_, registry_);
    for (std::size_t i = 0; i < plan.size(); ++i) results.results[i] = valid_result(plan[i]);
    say_what_is_there(results);
    if (again_)
      forget_outdated(plan);
    else
      refuse_to_replace(plan);
    write_text(output_ / "study.yaml", file_.effective_yaml);  // for reports before the end
    const CellFinished finished = [this](const Cell& cell, const CellResult& result,
                                         const StudyProgress& progress) {
      report(cell, result, progress);
    };
    if (with_slurm_) {
      follow_jobs(plan, stop, finished, results.results);
    } else {
      refuse_queued_jobs(jobs_folder());
      run_missing(plan, program(), jobs_, stop, finished, results.results);
    }
    return results;
  }

  fs::path jobs_folder() const { return output_ / "slurm"; }

  /// Before any work: there may be none.
  void ask_slurm() {
    make_folder(jobs_folder());
    slurm_ = {.name = file_.file.stem().string(),
              .folder = jobs_folder(),
              .program = this_program(),
              .largest_array = largest_array(jobs_folder() / "scontrol.txt"),
              .options = study().slurm};
  }

  void follow_jobs(const std::vector<PlannedCell>& plan, const std::stop_token& stop,
                   const CellFinished& finished, std::vector<std::optional<CellResult>>& results) {
    const SlurmEvents events{.finished = finished,
                             .note = [this](const std::string& text) { console_.note(text); },
                             .status = [this](const std::string& text) { console_.status(text); }};
    queued_jobs_ = run_missing_with_slurm(plan, program(), slurm_, stop, events, results);
  }

  void say_how_it_goes_on() {
    if (queued_jobs_.empty())
      console_.note("stopped; the same command resumes the study");
    else
      console_.note("no longer followed, but in Slurm's queue: job " + join(queued_jobs_) +
                    "; the same command follows it again, 'scancel " + join(queued_jobs_, " ") +
                    "' cancels it");
  }

  int recorded_repeats() const { return study().new_noise ? study().repeats : 1; }

  /// Throws Error(kUsage) when a recording would have to make room.
  void refuse_to_record_over() {
    for (int repeat = 0; repeat < recorded_repeats(); ++repeat)
      for (std::size_t i = 0; i < study().sequences.size(); ++i) {
        const Sequence sequence = at_repeat(study(), study().sequences[i], repeat);
        const fs::path recording = recording_of(output_, study(), i, repeat);
        if (!sequence.scene.empty() && is_recorded_otherwise(recording, describe_scene(sequence)))
          throw Error(Fault::kUsage,
                      "is simulated from a scene that has changed, and would be replaced",
                      recording.string(), kReplaceHint);
      }
  }

  /// One after the other: the simulator uses all cores. False: stopped.
  bool record_scenes(const std::stop_token& stop) {
    if (!again_) refuse_to_record_over();
    for (int repeat = 0; repeat < recorded_repeats(); ++repeat)
      for (std::size_t i = 0; i < study().sequences.size(); ++i)
        if (!record_scene(at_repeat(study(), study().sequences[i], repeat),
                          recording_of(output_, study(), i, repeat), stop))
          return false;
    return true;
  }

  bool record_scene(const Sequence& sequence, const fs::path& recording,
                    const std::stop_token& stop) {
    if (!sequence.scene.empty()) {
      const std::string description = describe_scene(sequence);
      if (!is_recorded(recording, description)) {
        console_.note("simulating " + sequence.name);
        if (!record(this_program(), sequence, description, recording, stop)) return false;
      }
    }
    // Before any run, not after the first.
    evaluation::read_trajectory(recording / "groundtruth.txt");
    return true;
  }

  Program program() {
    return {.fingerprint = program_fingerprint(files_of_program(registry_), contents_),
            .version = STILLPOINT_VERSION,
            .commit = built_from_commit()};
  }

  void say_what_is_there(const StudyResults& results) {
    const std::size_t there = results.cells.size() - results.missing();
    if (there == 0) return;
    console_.note(std::to_string(there) + " of " + std::to_string(results.cells.size()) +
                  " runs are there already");
    const std::string current = program().fingerprint;
    const auto older = std::ranges::count_if(
        results.results, [&](const auto& result) { return result && result->program != current; });
    if (older > 0)
      console_.line("warning: " + std::to_string(older) +
                    " of them were made by another build of the program; remove " +
                    (output_ / "runs").string() + " to run them again");
  }

  /// Throws Error(kUsage) when runs that have ended would have to make room.
  void refuse_to_replace(const std::vector<PlannedCell>& plan) const {
    const auto count = std::ranges::count_if(plan, has_outdated_result);
    if (count == 0) return;
    throw Error(Fault::kUsage,
                std::to_string(count) + " of " + std::to_string(plan.size()) +
                    " runs there were made from another pipeline, recording or seed, with another "
                    "network or plugin of yours, or by another version, and would be replaced",
                output_.string(), kReplaceHint);
  }

  /// All of them at once: until they are made again they are missing, also for reports.
  static void forget_outdated(const std::vector<PlannedCell>& plan) {
    for (const PlannedCell& cell : plan)
      if (has_outdated_result(cell)) CellFolder(cell.run).forget_result();
  }

  void report(const Cell& cell, const CellResult& result, const StudyProgress& progress) {
    std::string text = "[" + std::to_string(progress.done) + "/" + std::to_string(progress.of) +
                       "] " + name_of(study(), cell) + ": ";
    if (result.failed())
      text += "FAILED (exit code " + std::to_string(result.exit_code) + "): " + result.message;
    else if (result.values[kAte])
      text += "ATE " + fixed(*result.values[kAte], 4) + " m";
    else
      text += result.message;
    text += ", " + minutes(result.seconds);
    if (progress.done < progress.of) text += ", " + minutes(progress.remaining_seconds) + " left";
    console_.note(text);
  }

  void write(const StudyResults& results) const {
    const std::string tables = markdown_report(results, file_.file.stem().string());
    write_text(output_ / "study.yaml", file_.effective_yaml);
    write_text(output_ / "results.csv", csv_report(results));
    write_text(output_ / "summary.csv", csv_summary(results));
    write_text(output_ / "tables.tex", latex_report(results, file_.file.stem().string()));
    write_text(output_ / "results.md", tables);
    if (quiet_) return;
    std::cout << tables << "\nfiles in " << output_.string()
              << ": results.md tables.tex results.csv summary.csv study.yaml runs/\n"
              << std::flush;
  }

  void throw_if_failed(const StudyResults& results) const {
    if (results.failed() == 0) return;
    std::string list;
    for (std::size_t i = 0; i < results.cells.size(); ++i)
      if (const auto& result = results.results[i]; result && result->failed())
        list += "\n  " + name_of(study(), results.cells[i]) + ": exit code " +
                std::to_string(result->exit_code) + ": " + result->message;
    throw Error(Fault::kStage, std::to_string(results.failed()) + " of " +
                                   std::to_string(results.cells.size()) +
                                   " runs failed; the same command tries them again:" + list);
  }

  const std::string command_;
  Registry registry_;
  const StudyFile file_;
  FileContents contents_;
  const fs::path output_;
  const int jobs_;
  const bool with_slurm_;
  const bool again_;
  SlurmStudy slurm_;
  std::vector<std::string> queued_jobs_;  // that go on after Ctrl-C
  const bool quiet_;
  Console console_;
};

}  // namespace

void add_ablate(CLI::App& app) {
  auto arguments = std::make_shared<AblateArguments>();
  CLI::App* command =
      app.add_subcommand("ablate", "Run a matrix of sequences, variants and repeats; make tables");
  command
      ->add_option("study", arguments->study, "Study file, or the name of one in configs/studies")
      ->type_name("STUDY");
  command
      ->add_option("-o,--output", arguments->output,
                   "Folder for runs and tables; a study in it is resumed; default: out/STUDY")
      ->type_name("DIR");
  command
      ->add_option("-j,--jobs", arguments->jobs,
                   "Runs in parallel on this machine; use 1 to measure times")
      ->capture_default_str()
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
  command
      ->add_option("--executor", arguments->executor,
                   "Where the runs are made: local, on this machine; slurm, as jobs of a cluster")
      ->capture_default_str()
      ->check(CLI::IsMember({"local", "slurm"}))
      ->type_name("NAME");
  command->add_flag("--again", arguments->again,
                    "Run anew, and replace, what was made from another pipeline, scene or version");
  command->add_flag("-q,--quiet", arguments->quiet, "Print only warnings and errors");
  command
      ->add_flag("--list", arguments->list,
                 "List the studies in configs/studies: name, number of runs, question")
      ->excludes("study");
  command->callback([arguments] {
    if (arguments->list) return list_studies(std::cout);
    if (arguments->study.empty())
      throw Error(Fault::kUsage, "needs a study", "stillpoint ablate",
                  "name a file, or one that 'stillpoint ablate --list' prints");
    Ablation(*arguments).run();
  });
}

}  // namespace stillpoint
