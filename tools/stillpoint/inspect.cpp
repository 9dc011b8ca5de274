// stillpoint inspect: what a recording holds and what is wrong with it.
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "commands.hpp"
#include "inspection/audit_report.hpp"
#include "inspection/bag_audit.hpp"
#include "stillpoint/support/bag_files.hpp"

namespace stillpoint {
namespace {

struct InspectArguments {
  std::string recording, camera;
  inspection::AuditOptions options;
  bag::TopicNames topics;
  bool json = false;
};

/// The camera that is named, or the one that lies beside the recording.
std::optional<CameraModel> camera_for(const InspectArguments& arguments) {
  std::string file = arguments.camera;
  const auto beside = bag_path(arguments.recording) / "camera.yaml";
  if (file.empty() && std::filesystem::is_regular_file(beside)) file = beside.string();
  if (file.empty()) return std::nullopt;
  std::vector<std::string> warnings;
  CameraModel camera = load_camera(file, &warnings);
  for (const std::string& warning : warnings) std::cerr << "warning: " << warning << '\n';
  return camera;
}

template <class Audit>
void print_audit(const Audit& audit, bool json) {
  if (json)
    std::cout << inspection::report_json(audit).dump(2) << '\n';
  else
    std::cout << inspection::report_table(audit);
}

void print_inspection(InspectArguments arguments) {
  arguments.options.camera = camera_for(arguments);
  const inspection::AuditOptions& options = arguments.options;
  if (bag_files(arguments.recording).empty())
    print_audit(inspection::audit_recording(arguments.recording, options), arguments.json);
  else
    print_audit(inspection::audit_bag(arguments.recording,
                                      {.topics = arguments.topics,
                                       .camera = options.camera,
                                       .max_difference = options.pairing.max_difference,
                                       .time_offset = options.pairing.time_offset,
                                       .samples = options.samples}),
                arguments.json);
}

void add_topic_options(CLI::App& command, bag::TopicNames& topics) {
  command
      .add_option("--color-topic", topics.color,
                  "Topic of the colour images in a bag; default: chosen by type and name")
      ->type_name("TOPIC");
  command
      .add_option("--depth-topic", topics.depth,
                  "Topic of the depth images in a bag; default: chosen by type and name")
      ->type_name("TOPIC");
  command
      .add_option("--info-topic", topics.info,
                  "Topic of the CameraInfo in a bag; default: that beside the colour images")
      ->type_name("TOPIC");
  command
      .add_option("--depth-info-topic", topics.depth_info,
                  "Topic of the CameraInfo of depth that is not registered to colour; default: "
                  "that beside the depth images")
      ->type_name("TOPIC");
}

}  // namespace

void add_inspect(CLI::App& app) {
  auto arguments = std::make_shared<InspectArguments>();
  CLI::App* command = app.add_subcommand(
      "inspect",
      "Audit a recording or a bag: pairs, gaps, depth, time offset, ground truth, topics");
  command
      ->add_option("recording", arguments->recording,
                   "Folder in the format of the TUM benchmark, or a bag (.bag, .mcap, .db3)")
      ->type_name("PATH")
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
  command
      ->add_option("--samples", arguments->options.samples,
                   "Number of pairs whose images are read and checked")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  add_topic_options(*command, arguments->topics);
  command->add_flag("--json", arguments->json, "Print JSON instead of a table");
  command->callback([arguments] { print_inspection(*arguments); });
}

}  // namespace stillpoint
