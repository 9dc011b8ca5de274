// stillpoint evaluate: how far an estimated trajectory is from the true one.
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "commands.hpp"
#include "evaluation/evaluation.hpp"
#include "evaluation/plot.hpp"
#include "evaluation/report.hpp"

namespace stillpoint {
namespace {

struct Arguments {
  std::string reference, estimate, frames, plot;
  evaluation::EvaluationOptions options;
  bool json = false;
};

void run(const Arguments& arguments) {
  using namespace evaluation;
  const Evaluation result =
      evaluate(read_trajectory(arguments.reference), read_trajectory(arguments.estimate),
               arguments.frames.empty() ? std::vector<double>() : read_stamps(arguments.frames),
               arguments.options);
  if (!arguments.plot.empty()) write_plot(result, arguments.plot);
  if (arguments.json)
    std::cout << report_json(result).dump(2) << '\n';
  else
    std::cout << report_table(result);
}

}  // namespace

void add_evaluate(CLI::App& app) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("evaluate", "Compare a trajectory with ground truth: ATE, RPE, coverage");
  command->add_option("--reference", arguments->reference, "True trajectory, TUM format")
      ->required();
  command->add_option("--estimate", arguments->estimate, "Estimated trajectory, TUM format")
      ->required();
  command->add_option(
      "--frames", arguments->frames,
      "List of the recording's frames (rgb.txt, associations.txt) for the coverage");
  evaluation::EvaluationOptions& options = arguments->options;
  command
      ->add_option("--max-difference", options.max_difference,
                   "Poses further apart in time do not belong together, s")
      ->capture_default_str()
      ->check(CLI::Range(1e-6, 1.0));
  command->add_option("--offset", options.offset, "Added to the times of the estimate, s")
      ->capture_default_str()
      ->check(CLI::Number);
  command->add_option("--delta", options.delta.length, "Interval of the relative pose error")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  command->add_option("--delta-unit", options.delta.unit, "Of --delta: s (seconds) or f (frames)")
      ->default_str("s")
      ->transform(CLI::CheckedTransformer(std::map<std::string, evaluation::DeltaUnit>{
          {"s", evaluation::DeltaUnit::kSeconds}, {"f", evaluation::DeltaUnit::kFrames}}));
  command->add_flag("--json", arguments->json, "Print JSON instead of a table");
  command->add_option("--plot", arguments->plot, "Draw both trajectories and the error, PNG file");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace stillpoint
