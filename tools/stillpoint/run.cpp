// stillpoint run: a recording through a pipeline, and what comes out into a run folder.
#include <yaml-cpp/yaml.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "commands.hpp"
#include "commit.hpp"
#include "console.hpp"
#include "evaluation/origin.hpp"
#include "interrupt.hpp"
#include "map_saver.hpp"
#include "progress.hpp"
#include "run_folder.hpp"
#include "run_results.hpp"
#include "run_table.hpp"
#include "shell_word.hpp"
#include "stillpoint/engine/engine.hpp"
#include "stillpoint/engine/make_stages.hpp"
#include "stillpoint/engine/pipeline_warnings.hpp"
#include "stillpoint/engine/stage_error.hpp"
#include "stillpoint/engine/stage_guard.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;

struct RunArguments {
  PipelineRequest request;
  fs::path output;
  fs::path save_map, load_map;
  bool localise_only = false;
  bool images = false;
  std::string view_port;  // empty: no live view
  bool quiet = false;
};

void print_files(const RunFolder& folder, const fs::path& ground_truth) {
  std::cout << "  files     " << folder.path().string() << ":";
  for (const std::string& name : folder.contents()) std::cout << ' ' << name;
  std::cout << '\n';
  const fs::path trajectory = folder.path() / "trajectory.txt";
  if (!ground_truth.empty() && fs::exists(trajectory))
    std::cout << "  compare   stillpoint evaluate --reference " << shell_word(ground_truth.string())
              << " --estimate " << shell_word(trajectory.string()) << '\n';
}

template <class Function>
auto in_source(const Stages& stages, Function function) {
  return in_stage("source (" + stages.source.type + ")", {},
                  [&] { return std::invoke(function, *stages.source.object); });
}

/// A run that failed before its first frame has a log, too, where that replaces no other one.
void log_failure(const Error& failure, RunFolder& folder) {
  try {
    if (!folder.has_begun() && !folder.holds_earlier_run()) folder.begin();
  } catch (const Error& error) {  // the failure of the run matters more
    folder.log(LogLevel::kWarning, error.what());
  }
  folder.log(LogLevel::kInfo, std::string("failed: ") + failure.what());
  if (!folder.has_begun() && folder.holds_earlier_run())
    folder.log(LogLevel::kWarning, folder.path().string() + " still holds an earlier run");
}

// Without this list the next run leaves some files of this one: no reason to fail.
void list_results(const std::vector<fs::path>& files_of_map, const RunFolder& folder) {
  try {
    folder.list_results(files_of_map);
  } catch (const Error& error) {
    folder.log(LogLevel::kWarning, error.what());
  }
}

// Runs, and prints the table also when a stage has failed: what was computed is saved. Whether the
// run came to its end.
bool run_and_print(Stages stages, const PipelineConfig& config, RunFolder& folder, bool quiet,
                   std::stop_token stop) {
  const fs::path ground_truth = in_source(stages, &Source::ground_truth);
  // A camera that does not fit, or a network that cannot be used, must not cost the results of an
  // earlier run.
  stages.before_outputs = [&folder] { folder.begin(); };
  std::vector<fs::path> files_of_map;
  stages.map_saved = [&files_of_map](const auto& files) { files_of_map = files; };
  const auto table = std::make_shared<RunTable>();
  stages.outputs.push_back({{table, "table"}});
  const auto end = [&] {
    if (!folder.has_begun()) return;
    list_results(files_of_map, folder);
    if (quiet) return;
    table->print(std::cout);
    print_files(folder, ground_truth);
    std::cout << std::flush;
  };
  Engine engine(std::move(stages), config.runtime, config.segmentation);
  try {
    engine.run(std::move(stop));
  } catch (const Error& error) {
    end();
    log_failure(error, folder);
    if (StageGuard::has_ended_a_call()) {  // nothing more of its plugin is to be run
      std::cerr << "error: " << error.what() << std::endl;
      std::_Exit(error.exit_code());
    }
    throw;
  }
  end();
  if (table->no_frames() && table->complete())
    folder.log(LogLevel::kWarning, "the source gave no frame: the trajectory is empty");
  if (table->nothing_tracked())
    folder.log(
        LogLevel::kWarning,
        "no frame was tracked: the trajectory is empty; 'stillpoint inspect' says whether the "
        "camera and the depth fit the images");
  return table->complete();
}

/// Between what the run reads, what it writes elsewhere, and the files of its folder.
void require_no_conflicts(const RunArguments& arguments, const PipelineConfig& config,
                          const RunFolder& folder) {
  if (!arguments.load_map.empty()) folder.require_no_input_in_the_way(arguments.load_map);
  for (const auto& option : YAML::Load(config.effective_yaml)["source"])
    if (option.second.IsScalar()) folder.require_no_input_in_the_way(option.second.Scalar());
  if (!arguments.save_map.empty()) folder.require_no_result_in_place_of(arguments.save_map);
}

/// Gives the signal that has stopped it, or 0.
int run(const RunArguments& arguments) {
  std::optional<LateCalls> loading(watch_loading());
  Registry registry;
  PipelineRequest request = arguments.request;
  if (arguments.images) request.outputs.emplace_back("images");
  if (!arguments.view_port.empty()) request.outputs.push_back("web.port=" + arguments.view_port);
  const PipelineConfig config = load_pipeline(request, registry);
  SparseMap known_map = arguments.load_map.empty() ? SparseMap() : load_map(arguments.load_map);
  std::shared_ptr<MapSaver> saver;
  if (!arguments.save_map.empty()) saver = std::make_shared<MapSaver>(arguments.save_map);
  Console console(arguments.quiet);
  RunFolder folder(
      arguments.output.empty() ? fs::path("out") / config.file.stem() : arguments.output,
      config.effective_yaml, console);
  require_no_conflicts(arguments, config, folder);
  folder.log(LogLevel::kInfo, "stillpoint " STILLPOINT_VERSION ", " + config.file.string());
  folder.log(LogLevel::kInfo,
             "by " + origin_text(evaluation::origin_of(
                         {.version = STILLPOINT_VERSION, .commit = built_from_commit()})));
  loading.reset();
  const LateCalls late(config.runtime.stage_timeout, [&folder](const std::string& text) {
    folder.log(LogLevel::kWarning, text + "; Ctrl-C stops the run");
  });
  for (const std::string& warning : warnings_of(config)) folder.log(LogLevel::kWarning, warning);
  Stages stages = make_stages(config, folder.path(), [&](LogLevel level, std::string_view text) {
    folder.log(level, text);
    if (level == LogLevel::kInfo) console.note(std::string(text));
  });
  if (!arguments.quiet)
    stages.outputs.push_back(
        {{std::make_shared<Progress>(console, in_source(stages, &Source::size)), "progress"}});
  stages.known_map = std::move(known_map);
  stages.localise_only = arguments.localise_only;
  stages.map_file = arguments.save_map.empty() ? folder.path() / kRunMap : arguments.save_map;
  if (saver) stages.outputs.push_back({{std::move(saver), "map saver"}});
  bool complete = false;
  int signal = 0;
  {
    const Interrupt interrupt([&console](const std::string& line) { console.line(line); });
    complete = run_and_print(std::move(stages), config, folder, arguments.quiet, interrupt.token());
    signal = Interrupt::signal();
  }
  if (complete && signal == 0)
    folder.log(LogLevel::kInfo, "done");
  else if (folder.has_begun())
    folder.log(LogLevel::kWarning, "stopped; what was computed until then is saved");
  else
    folder.log(LogLevel::kWarning, "stopped before the first frame; nothing was written");
  return signal;
}

}  // namespace

void add_run(CLI::App& app) {
  auto arguments = std::make_shared<RunArguments>();
  CLI::App* command = app.add_subcommand("run", "Process a recording with a pipeline");
  add_pipeline_options(*command, arguments->request);
  command
      ->add_option("-o,--output", arguments->output,
                   "Folder for the results; default: out/PIPELINE")
      ->type_name("DIR");
  command
      ->add_option(
          "--with", arguments->request.outputs,
          "Add an output of this type to those of the file, or set one of its options, as in "
          "--with images.every=10; may be repeated")
      ->type_name("TYPE[.OPTION=VALUE]")
      ->allow_extra_args(false);
  command->add_flag("--images", arguments->images,
                    "Draw one frame in 30 with labels and features: --with images");
  command->add_flag(
      "--view{8080}", arguments->view_port,
      "Show the run in a browser, at this port of this machine; 0 takes any that is free");
  command->add_flag("-q,--quiet", arguments->quiet, "Print only warnings and errors");
  command->add_option("--save-map", arguments->save_map, "Keep the sparse map in this file")
      ->type_name("FILE");
  CLI::Option* load = command
                          ->add_option("--load-map", arguments->load_map,
                                       "Begin with the sparse map of an earlier run")
                          ->type_name("FILE");
  command
      ->add_flag("--localise-only", arguments->localise_only,
                 "Only localise in the loaded map, without changing it")
      ->needs(load);
  command->callback([arguments] {
    // A calling script sees that it was interrupted.
    if (const int signal = run(*arguments)) std::raise(signal);
  });
}

}  // namespace stillpoint
