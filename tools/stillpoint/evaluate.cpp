// stillpoint evaluate: how far an estimated trajectory is from the true one.
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "evaluation/comparison.hpp"
#include "evaluation/report.hpp"
#include "figures/evaluation_figure.hpp"
#include "figures/figure_file.hpp"
#include "in_folder.hpp"
#include "stillpoint/error.hpp"
#include "typed_command.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;

struct EvaluateArguments {
  std::string reference, estimate, frames, plot, aligned, delta_unit = "s";
  evaluation::EvaluationOptions options;
  bool json = false;
};

fs::path reference_file(const EvaluateArguments& arguments) {
  return in_folder(arguments.reference, "groundtruth.txt");
}

fs::path estimate_file(const EvaluateArguments& arguments) {
  return in_folder(arguments.estimate, "trajectory.txt");
}

/// Throws Error(kUsage) where the aligned trajectory would replace what it is made from.
void require_no_input(const EvaluateArguments& arguments) {
  std::error_code none;
  for (const fs::path& input :
       {reference_file(arguments), estimate_file(arguments), fs::path(arguments.frames)})
    if (fs::equivalent(arguments.aligned, input, none))
      throw Error(Fault::kUsage, "is read by this command, and would be replaced",
                  arguments.aligned, "choose another file for --aligned");
}

void print_evaluation(const EvaluateArguments& arguments) {
  using namespace evaluation;
  EvaluationOptions options = arguments.options;
  require_numbers({options.max_difference, options.offset, options.delta.length});
  if (!arguments.plot.empty()) figures::format_of(arguments.plot);  // before the work
  require_no_input(arguments);
  options.delta.unit = delta_unit_of(arguments.delta_unit);
  Trajectory reference = read_trajectory(reference_file(arguments));
  Trajectory estimate = read_trajectory(estimate_file(arguments));
  const std::vector<double> frames =
      arguments.frames.empty() ? std::vector<double>() : read_stamps(arguments.frames);
  const Evaluation result = evaluate(std::move(reference), std::move(estimate), frames, options);
  if (arguments.json) {
    nlohmann::ordered_json json = report_json(result);
    json["made_by"] = made_by_json();
    std::cout << json.dump(2) << '\n';
  } else {
    std::cout << report_table(result) << '\n' << made_by();
  }
  if (!arguments.aligned.empty())
    write_trajectory(arguments.aligned,
                     aligned(result.rigid.reference_from_estimate, result.estimate));
  if (arguments.plot.empty()) return;
  const std::vector<Contestant> runs = {{name_of_run(arguments.estimate), result, result.rigid}};
  figures::write_figure(figures::evaluation_figure(runs), arguments.plot);
}

}  // namespace

void add_delta_unit(CLI::App& command, std::string& unit) {
  command
      .add_option("--delta-unit", unit,
                  "Of --delta: s (seconds), f (frames), m (metres along the estimate)")
      ->capture_default_str()
      ->check(CLI::IsMember({"s", "f", "m"}))
      ->type_name("s|f|m");
}

void add_evaluate(CLI::App& app) {
  auto arguments = std::make_shared<EvaluateArguments>();
  CLI::App* command =
      app.add_subcommand("evaluate", "Compare a trajectory with ground truth: ATE, RPE, coverage");
  const auto file = [&](const char* name, std::string& path, const char* help,
                        const char* type = "FILE") {
    return command->add_option(name, path, help)->type_name(type);
  };
  const auto number = [&](const char* name, double& value, const char* help, double min,
                          double max) {
    command->add_option(name, value, help)
        ->capture_default_str()
        ->check(CLI::Range(min, max))
        ->type_name("NUMBER");
  };
  file("--reference", arguments->reference,
       "True trajectory, format of TUM, EuRoC or KITTI; or folder of a recording with "
       "groundtruth.txt",
       "PATH")
      ->required();
  file("--estimate", arguments->estimate,
       "Estimated trajectory, in any of these formats; or folder of a run", "PATH")
      ->required();
  file("--frames", arguments->frames,
       "List of all frames of the recording (rgb.txt, associations.txt), to tell how many of them "
       "have a pose");
  evaluation::EvaluationOptions& options = arguments->options;
  number("--max-difference", options.max_difference,
         "Largest time difference of poses that are compared, s", 1e-6, 1.0);
  number("--offset", options.offset, "Added to the times of the estimate, s", -1e10, 1e10);
  number("--delta", options.delta.length, "Interval of the relative pose error", 1e-3, 1e6);
  add_delta_unit(*command, arguments->delta_unit);
  command->add_flag("--json", arguments->json, "Print JSON instead of a table");
  file("--plot", arguments->plot, "Draw both trajectories and the error: .png, .svg or .pdf");
  file("--aligned", arguments->aligned,
       "Write the estimate after SE(3) alignment to the reference, TUM format");
  command->callback([arguments] { print_evaluation(*arguments); });
}

}  // namespace stillpoint
