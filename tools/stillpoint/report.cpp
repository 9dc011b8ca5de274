// stillpoint report: a page and tables of runs or of a study.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "commands.hpp"
#include "commit.hpp"
#include "evaluation/format.hpp"
#include "evaluation/origin.hpp"
#include "evaluation/trajectory.hpp"
#include "in_folder.hpp"
#include "report/figures.hpp"
#include "report/page.hpp"
#include "report/report_reader.hpp"
#include "report/run_reader.hpp"
#include "report/table_files.hpp"
#include "stillpoint/engine/install_layout.hpp"
#include "stillpoint/error.hpp"
#include "study/text_file.hpp"
#include "study_file.hpp"
#include "typed_command.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;

struct ReportArguments {
  std::vector<fs::path> folders;
  fs::path output, figures, reference;
  std::string base;
};

fs::path page_file() { return installation_folder() / "share/stillpoint/report.html"; }

/// Every option of a pipeline as a run of that recording has it.
std::string effective_yaml(const std::string& pipeline, const fs::path& recording) {
  const LateCalls late = watch_loading();
  Registry registry;
  PipelineRequest request{.pipeline = pipeline};
  if (!recording.empty()) request.dataset = recording.string();
  return load_pipeline(request, registry).effective_yaml;
}

/// A lone run is compared with the file that it was made from, where that can still be read.
void compare_with_its_file(report::RunData& run) {
  if (run.pipeline.empty()) return;
  try {
    compare_options(run, run.pipeline.stem().string(),
                    effective_yaml(run.pipeline.string(), run.dataset));
  } catch (const Error&) {  // the file is gone, or no longer fits: nothing to compare with
  }
}

/// Empty: none was named. Throws Error where it cannot be read, for all runs need it.
fs::path true_trajectory(const ReportArguments& arguments) {
  if (arguments.reference.empty()) return {};
  const fs::path file = in_folder(arguments.reference, "groundtruth.txt");
  evaluation::read_trajectory(file);
  return file;
}

report::ReportData read(const ReportArguments& arguments) {
  const auto study = std::ranges::find_if(
      arguments.folders, [](const fs::path& folder) { return fs::exists(folder / "study.yaml"); });
  const bool is_study = study != arguments.folders.end();
  if (is_study && arguments.folders.size() > 1)
    throw Error(Fault::kUsage, "a report is of one study, or of runs", study->string(),
                "give it alone");
  if (is_study && !arguments.reference.empty())
    throw Error(Fault::kUsage, "the recordings of a study have their own truth", study->string(),
                "leave out --reference");
  report::ReportData data = is_study
                                ? report::read_study(*study, read_study(*study / "study.yaml"))
                                : report::read_runs(arguments.folders, true_trajectory(arguments));
  if (!is_study) data.command = typed_command();
  if (!arguments.base.empty()) {
    std::map<fs::path, std::string> yaml;  // by recording: loading a pipeline takes a while
    for (report::RunData& run : data.runs) {
      std::string& base = yaml[run.dataset];
      if (base.empty()) base = effective_yaml(arguments.base, run.dataset);
      compare_options(run, arguments.base, base);
    }
  } else if (data.runs.size() == 1) {
    compare_with_its_file(data.runs.front());
  }
  return data;
}

/// Throws Error(kUsage) where the file is none of an earlier report: results of the study, or of
/// the user.
void require_own(const fs::path& file) {
  if (fs::exists(file) && !report::is_table_file(study::read_text(file)))
    throw Error(Fault::kUsage, "is no table of an earlier report, and would be replaced",
                file.string(), "give the page another name with -o");
}

void write_report(const ReportArguments& arguments) {
  using study::write_text;
  const bool alone = arguments.folders.size() == 1;
  const fs::path page = !arguments.output.empty() ? arguments.output
                        : alone                   ? arguments.folders.front() / "report.html"
                                                  : fs::path("report.html");
  if (page.extension() != ".html")  // or its tables could take its place
    throw Error(Fault::kUsage, "a page is an .html file", page.string(),
                "name it with -o FILE.html");
  const auto beside = [&](const char* ending) {
    return fs::absolute(page).replace_extension(ending);
  };
  require_own(beside(".csv"));
  require_own(beside(".tex"));
  const report::ReportData data = read(arguments);
  if (!arguments.figures.empty())
    std::cout << report::write_figures(data, arguments.figures) << " figures in "
              << arguments.figures.string() << ", each as SVG and PDF\n";
  const evaluation::Origin here =
      evaluation::origin_of({.version = STILLPOINT_VERSION, .commit = built_from_commit()});
  const std::string html = filled_page(page_file(), data, fs::absolute(page).parent_path(),
                                       "Stillpoint " STILLPOINT_VERSION ", " + here.date);
  write_text(fs::absolute(page), html);
  std::vector<std::string> origins = data.origins;
  if (!data.command.empty()) origins.insert(origins.begin(), data.command);
  write_text(beside(".csv"), report::csv_tables(data.tables, origins));
  origins.insert(origins.end(), data.notes.begin(), data.notes.end());  // what is incomplete
  write_text(beside(".tex"), report::latex_tables(data.tables, origins));
  for (const std::string& note : data.notes) std::cerr << "note: " << note << '\n';
  std::cout << page.string() << " (" << evaluation::fixed(static_cast<double>(html.size()) / 1e6, 1)
            << " MB); tables: " << beside(".tex").filename().string() << ", "
            << beside(".csv").filename().string() << '\n';
}

}  // namespace

void add_report(CLI::App& app) {
  auto arguments = std::make_shared<ReportArguments>();
  CLI::App* command =
      app.add_subcommand("report", "Write a page with figures and tables, of runs or of a study");
  command->add_option("folders", arguments->folders, "Run folders, or the folder of a study")
      ->type_name("DIR")
      ->required()
      ->check(CLI::ExistingDirectory);
  command
      ->add_option(
          "-o,--output", arguments->output,
          "The page; beside it lie its tables, as .tex and .csv. Default: report.html in the "
          "folder, or here when there are several")
      ->type_name("FILE");
  command
      ->add_option("--reference", arguments->reference,
                   "True trajectory of all runs, or folder of a recording with groundtruth.txt. "
                   "Default: groundtruth.txt of each run's recording")
      ->type_name("PATH");
  command
      ->add_option("--figures", arguments->figures,
                   "Folder for every figure as SVG and PDF, for papers")
      ->type_name("DIR");
  command
      ->add_option("--base", arguments->base,
                   "Pipeline file or name; the page lists in which options each run differs from "
                   "it. Default: the file that was run; for several runs, the pipeline of the "
                   "first; for a study, its baseline")
      ->type_name("PIPELINE");
  command->callback([arguments] { write_report(*arguments); });
}

}  // namespace stillpoint
