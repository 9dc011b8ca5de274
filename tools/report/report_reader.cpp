#include "report/report_reader.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "report/report_tables.hpp"
#include "report/run_reader.hpp"
#include "report/run_tables.hpp"
#include "stillpoint/error.hpp"
#include "study/claim.hpp"
#include "study/matrix.hpp"
#include "study/provenance.hpp"
#include "study/text_file.hpp"

namespace stillpoint::report {
namespace {

namespace fs = std::filesystem;
using study::Cell;
using study::CellResult;
using study::Study;
using study::StudyResults;

/// "fr3" of "out/fr3/".
std::string last_name(const fs::path& folder) {
  const fs::path path = fs::absolute(folder).lexically_normal();
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

/// The names of the folders, or their paths where two have one name.
std::vector<std::string> names_of(const std::vector<fs::path>& folders) {
  std::map<std::string, int> count;
  for (const fs::path& folder : folders) ++count[last_name(folder)];
  std::vector<std::string> names;
  for (const fs::path& folder : folders) {
    const std::string name = last_name(folder);
    names.push_back(count[name] > 1 ? folder.lexically_normal().string() : name);
  }
  return names;
}

std::string state_note(const fs::path& run, bool has_result) {
  if (has_result) return {};
  if (fs::exists(run / "result.json"))
    return "result.json cannot be read: damaged, or written by another version.";
  return "Not finished: there is no result yet.";
}

StudyResults results_of(const fs::path& folder, const Study& study) {
  StudyResults results{.study = study,
                       .cells = cells_of(study),
                       .results = {},
                       .command = study::command_of(folder)};
  for (const Cell& cell : results.cells)
    results.results.push_back(study::read_result(run_folder(folder, study, cell)));
  return results;
}

RunData run_of_cell(const fs::path& folder, const StudyResults& results, std::size_t i) {
  const Study& study = results.study;
  const Cell& cell = results.cells[i];
  const fs::path run_path = run_folder(folder, study, cell);
  RunData run = read_run(run_path, name_of(study, cell),
                         {.dataset = recording_of(folder, study, cell.sequence, cell.repeat)});
  run.variant = study.variants[cell.variant].name;
  run.recording = study.sequences[cell.sequence].name;
  if (const std::string note = state_note(run_path, results.results[i].has_value()); !note.empty())
    run.notes.insert(run.notes.begin(), note);
  if (!results.results[i]) return run;
  const CellResult& result = *results.results[i];
  run.made_by = origin_text(result.origin);
  if (run.truth.empty() && result.values[study::kAte])
    run.notes.emplace_back(
        "The tables of the study have the errors that were measured when the run ended.");
  if (result.failed()) {
    run.complete = false;
    run.notes.insert(
        run.notes.begin(),
        "Failed with exit code " + std::to_string(result.exit_code) + ": " + result.message);
  }
  return run;
}

/// Against the baseline's run of the same sequence and repeat, or the first variant's.
void compare_with_variant(std::vector<RunData>& runs, const Study& study) {
  if (study.variants.empty()) return;
  const auto named = std::ranges::find(study.variants, study.baseline, &study::Variant::name);
  const std::string base = named == study.variants.end() ? study.variants[0].name : named->name;
  std::map<std::string, const std::string*> yaml;
  for (const RunData& run : runs) yaml[run.name] = &run.yaml;
  for (RunData& run : runs) {
    const std::size_t first = run.name.find('/'), last = run.name.rfind('/');
    const auto found = yaml.find(run.name.substr(0, first + 1) + base + run.name.substr(last));
    if (found != yaml.end()) compare_options(run, base, *found->second);
  }
}

/// The first note of each run. What several have in common is said once.
std::vector<std::string> notes_of_runs(const std::vector<RunData>& runs) {
  struct CommonNote {
    std::string text;
    const RunData* first;
    std::size_t runs;
  };
  std::vector<CommonNote> common;
  for (const RunData& run : runs) {
    if (run.notes.empty()) continue;
    const auto known = std::ranges::find(common, run.notes.front(), &CommonNote::text);
    if (known == common.end())
      common.push_back({run.notes.front(), &run, 1});
    else
      ++known->runs;
  }
  std::vector<std::string> notes;
  for (const CommonNote& note : common)
    notes.push_back(note.first->name +
                    (note.runs > 1 ? " and " + std::to_string(note.runs - 1) + " more" : "") +
                    ": " + note.text);
  return notes;
}

std::vector<std::string> notes_of(const StudyResults& results, const std::vector<RunData>& runs) {
  std::vector<std::string> notes;
  const std::size_t missing = results.missing();
  if (missing > 0)
    notes.push_back("Not finished: " + std::to_string(missing) + " of " +
                    std::to_string(results.cells.size()) + " runs have no result; '" +
                    results.command + "' makes them.");
  for (std::string& note : notes_of_runs(runs)) notes.push_back(std::move(note));
  return notes;
}

}  // namespace

ReportData read_runs(const std::vector<fs::path>& folders, const fs::path& truth) {
  ReportData data;
  const std::vector<std::string> names = names_of(folders);
  std::set<std::string> builds;
  for (std::size_t i = 0; i < folders.size(); ++i) {
    if (!is_run(folders[i]))
      throw Error(Fault::kUsage, "holds neither a run nor a study", folders[i].string(),
                  "name a folder that 'stillpoint run' or 'stillpoint ablate' has written");
    data.runs.push_back(read_run(folders[i], names[i], {.truth = truth}));
    RunData& run = data.runs.back();
    if (!run.made_by.empty()) builds.insert(run.made_by);
    for (const std::string& note : run.notes)
      data.notes.push_back(folders.size() > 1 ? run.name + ": " + note : note);
    if (i > 0) compare_options(run, names[0], data.runs[0].yaml);
  }
  data.title = folders.size() == 1 ? names[0] : std::to_string(folders.size()) + " runs";
  data.origins.assign(builds.begin(), builds.end());
  data.tables = {run_table(data.runs)};
  return data;
}

ReportData read_study(const fs::path& folder, const Study& study) {
  const StudyResults results = results_of(folder, study);
  ReportData data{
      .title = last_name(folder), .question = study.question, .command = results.command};
  for (std::size_t i = 0; i < results.cells.size(); ++i)
    if (fs::exists(run_folder(folder, study, results.cells[i])))
      data.runs.push_back(run_of_cell(folder, results, i));
  compare_with_variant(data.runs, study);
  data.origins = study::provenance(results);
  data.notes = notes_of(results, data.runs);
  data.tables = report_tables(results);
  data.tables.push_back(run_table(data.runs));
  return data;
}

}  // namespace stillpoint::report
