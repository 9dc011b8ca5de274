// The subcommands of the program. Each function adds its own to the command line; what it does runs
// as the subcommand's callback and fails by throwing stillpoint::Error.
#pragma once

#include <CLI/CLI.hpp>
#include <initializer_list>
#include <string>
#include <vector>

#include "stillpoint/engine/pipeline_config.hpp"
#include "stillpoint/engine/stage_guard.hpp"

namespace stillpoint {

void add_ablate(CLI::App& app);
void add_check(CLI::App& app);
void add_compare(CLI::App& app);
void add_evaluate(CLI::App& app);
void add_import(CLI::App& app);
void add_inspect(CLI::App& app);
void add_map(CLI::App& app);
void add_plugins(CLI::App& app);
/// Below `plugins`.
void add_plugins_check(CLI::App& plugins);
void add_plugins_new(CLI::App& plugins);
void add_record(CLI::App& app);
void add_report(CLI::App& app);
void add_run(CLI::App& app);
/// For jobs of studies, not listed by --help.
void add_run_cell(CLI::App& app);
void add_simulate(CLI::App& app);

/// What the last of the words after the program's name can become, for the completion of shells.
void print_completions(const CLI::App& app, std::vector<std::string> words);

/// PIPELINE, --dataset, --camera and --set, for every subcommand that reads a pipeline file.
void add_pipeline_options(CLI::App& command, PipelineRequest& request);

/// While the result lives, stderr is told of a plugin that holds up loading.
LateCalls watch_loading();

/// --delta-unit: of --delta, the interval of the relative pose error.
void add_delta_unit(CLI::App& command, std::string& unit);

/// For values with a range, through which CLI11 lets "nan". Throws Error(kUsage).
void require_numbers(std::initializer_list<double> values);

}  // namespace stillpoint
