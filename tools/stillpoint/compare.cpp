// stillpoint compare: several trajectories against one reference, ours and those of other systems.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "evaluation/comparison.hpp"
#include "figures/evaluation_figure.hpp"
#include "figures/figure_file.hpp"
#include "in_folder.hpp"
#include "stillpoint/error.hpp"
#include "typed_command.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;
using evaluation::AlignmentKind;

constexpr std::pair<const char*, AlignmentKind> kAlignments[] = {
    {"se3", AlignmentKind::kRigid},
    {"sim3", AlignmentKind::kSimilarity},
    {"yaw", AlignmentKind::kYaw},
    {"origin", AlignmentKind::kOrigin},
    {"none", AlignmentKind::kNone}};

struct CompareArguments {
  std::string reference, plot, alignment = "se3", delta_unit = "s";
  std::vector<std::string> runs;
  evaluation::EvaluationOptions options;
  bool json = false;
};

struct NamedFile {
  std::string name;
  fs::path file;
};

/// "NAME=PATH", or PATH, which is then named after its folder or file.
NamedFile parse_run(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals != std::string::npos && equals > 0 && !fs::exists(text))
    return {text.substr(0, equals), in_folder(text.substr(equals + 1), "trajectory.txt")};
  return {name_of_run(text), in_folder(fs::path(text).lexically_normal(), "trajectory.txt")};
}

std::vector<NamedFile> parse_runs(const std::vector<std::string>& texts) {
  std::vector<NamedFile> runs;
  for (const std::string& text : texts) {
    NamedFile run = parse_run(text);
    if (std::ranges::find(runs, run.name, &NamedFile::name) != runs.end())
      throw Error(Fault::kUsage, "two runs are named '" + run.name + "'", "stillpoint compare",
                  "give them names: NAME=" + run.file.string());
    runs.push_back(std::move(run));
  }
  return runs;
}

/// The estimate at the scale of the reference: a relative error is in metres of the reference.
evaluation::Trajectory scaled(const evaluation::Evaluation& evaluation) {
  evaluation::Trajectory trajectory = evaluation.estimate;
  for (StampedPose& pose : trajectory.poses)
    pose.world_from_camera.translation() *= evaluation.similarity.reference_from_estimate.scale;
  return trajectory;
}

evaluation::Comparison compare(const CompareArguments& arguments) {
  using namespace evaluation;
  EvaluationOptions options = arguments.options;
  options.delta.unit = delta_unit_of(arguments.delta_unit);
  Comparison comparison;
  for (const auto& [name, kind] : kAlignments)
    if (arguments.alignment == name) comparison.alignment = kind;
  const Trajectory reference = read_trajectory(in_folder(arguments.reference, "groundtruth.txt"));
  for (const NamedFile& run : parse_runs(arguments.runs)) {
    Contestant one{run.name, evaluate(reference, read_trajectory(run.file), {}, options), {}};
    if (comparison.alignment == AlignmentKind::kSimilarity)
      one.evaluation.relative = evaluate(reference, scaled(one.evaluation), {}, options).relative;
    one.error = absolute_error(one.evaluation.reference, one.evaluation.estimate,
                               one.evaluation.pairs, comparison.alignment);
    comparison.contestants.push_back(std::move(one));
  }
  return comparison;
}

void print_comparison(const CompareArguments& arguments) {
  using namespace evaluation;
  require_numbers(
      {arguments.options.max_difference, arguments.options.offset, arguments.options.delta.length});
  if (!arguments.plot.empty()) figures::format_of(arguments.plot);  // before the work
  const Comparison comparison = compare(arguments);
  if (arguments.json)
    std::cout << nlohmann::ordered_json(
                     {{"made_by", made_by_json()}, {"runs", comparison_json(comparison)}})
                     .dump(2)
              << '\n';
  else
    std::cout << comparison_table(comparison) << '\n' << made_by();
  if (!arguments.plot.empty())
    figures::write_figure(figures::evaluation_figure(comparison.contestants), arguments.plot);
}

}  // namespace

void add_compare(CLI::App& app) {
  auto arguments = std::make_shared<CompareArguments>();
  CLI::App* command =
      app.add_subcommand("compare", "Compare several trajectories, also of other systems");
  command
      ->add_option("runs", arguments->runs,
                   "Run folders, or trajectories of the format of TUM, EuRoC or KITTI")
      ->type_name("[NAME=]RUN")
      ->required();
  command
      ->add_option("--reference", arguments->reference,
                   "True trajectory, or folder of a recording with groundtruth.txt")
      ->type_name("PATH")
      ->required();
  std::vector<std::string> names;
  for (const auto& [name, kind] : kAlignments) names.emplace_back(name);
  command
      ->add_option("--align", arguments->alignment,
                   "How each is placed beside the reference: se3 (turned and moved), sim3 (scaled, "
                   "too), yaw (turned about z only), origin (first poses together), none")
      ->capture_default_str()
      ->check(CLI::IsMember(names))
      ->type_name("KIND");
  const auto number = [&](const char* name, double& value, const char* help, double min,
                          double max) {
    command->add_option(name, value, help)
        ->capture_default_str()
        ->check(CLI::Range(min, max))
        ->type_name("NUMBER");
  };
  evaluation::EvaluationOptions& options = arguments->options;
  number("--max-difference", options.max_difference,
         "Largest time difference of poses that are compared, s", 1e-6, 1.0);
  number("--offset", options.offset, "Added to the times of all runs, s", -1e10, 1e10);
  number("--delta", options.delta.length, "Interval of the relative pose error", 1e-3, 1e6);
  add_delta_unit(*command, arguments->delta_unit);
  command->add_flag("--json", arguments->json, "Print JSON instead of a table");
  command
      ->add_option("--plot", arguments->plot,
                   "Draw all trajectories and their errors: .png, .svg or .pdf")
      ->type_name("FILE");
  command->callback([arguments] { print_comparison(*arguments); });
}

}  // namespace stillpoint
