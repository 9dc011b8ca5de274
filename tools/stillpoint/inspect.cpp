// stillpoint inspect: what a recording holds and what is wrong with it.
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include "commands.hpp"
#include "inspection/audit_report.hpp"

namespace stillpoint {
namespace {

struct InspectArguments {
  std::string folder, camera;
  inspection::AuditOptions options;
  bool json = false;
};

/// The camera that is named, or the one that lies beside the recording.
std::optional<CameraModel> camera_for(const InspectArguments& arguments) {
  if (!arguments.camera.empty()) return load_camera(arguments.camera);
  const auto beside = std::filesystem::path(arguments.folder) / "camera.yaml";
  if (std::filesystem::is_regular_file(beside)) return load_camera(beside.string());
  return std::nullopt;
}

void print_inspection(InspectArguments arguments) {
  arguments.options.camera = camera_for(arguments);
  const auto audit = inspection::audit_recording(arguments.folder, arguments.options);
  if (arguments.json)
    std::cout << inspection::report_json(audit).dump(2) << '\n';
  else
    std::cout << inspection::report_table(audit);
}

}  // namespace

void add_inspect(CLI::App& app) {
  auto arguments = std::make_shared<InspectArguments>();
  CLI::App* command = app.add_subcommand(
      "inspect", "Audit a recording: pairs, gaps, depth, time offset, ground truth");
  command->add_option("recording", arguments->folder, "Folder in the format of the TUM benchmark")
      ->type_name("DIR")
      ->required();
  command
      ->add_option("--camera", arguments->camera,
                   "Camera file, or the name of one in configs/cameras; default: the camera.yaml "
                   "beside the recording")
      ->type_name("CAMERA");
  inspection::RecordingOptions& pairing = arguments->options.pairing;
  command
      ->add_option("--max-difference", pairing.max_difference,
                   "Largest time difference of colour and depth in a pair, s")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 10.0));
  command->add_option("--time-offset", pairing.time_offset, "Added to the depth stamps, s")
      ->capture_default_str()
      ->check(CLI::Range(-10.0, 10.0));
  command->add_option("--samples", arguments->options.samples, "Pairs whose images are read")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  command->add_flag("--json", arguments->json, "Print JSON instead of a table");
  command->callback([arguments] { print_inspection(*arguments); });
}

}  // namespace stillpoint
