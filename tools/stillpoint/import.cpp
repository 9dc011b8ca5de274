// stillpoint import: a recording of another data set as a folder of the TUM benchmark.
#include <csignal>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "commands.hpp"
#include "console.hpp"
#include "importing/layout.hpp"
#include "importing/recording_folder.hpp"
#include "inspection/audit_report.hpp"
#include "interrupt.hpp"
#include "stillpoint/support/did_you_mean.hpp"

namespace stillpoint {
namespace {

struct ImportArguments {
  std::string recording, layout, camera;
  std::filesystem::path output;
  std::size_t frames = 0;  // 0: all
  bool quiet = false;
};

importing::ImportOptions options_of(const ImportArguments& arguments,
                                    const importing::Layout& layout) {
  importing::ImportOptions options;
  options.camera_is_users = !arguments.camera.empty();
  if (options.camera_is_users)
    options.camera = load_camera(arguments.camera);
  else if (layout.camera)
    options.camera = load_camera(layout.camera);
  if (arguments.frames > 0) options.most_frames = arguments.frames;
  return options;
}

/// "1000 images are hard links to those of the recording, 12 were written".
std::string what_became_of_images(const importing::RecordingFolder& folder) {
  std::vector<std::string> parts;
  const auto say = [&parts](std::size_t count, const char* what) {
    if (count > 0) parts.push_back(std::to_string(count) + what);
  };
  say(folder.linked(), " are hard links to those of the recording");
  say(folder.copied(), " were copied");
  say(folder.written(), " were written anew");
  return "images: " + join(parts);
}

void print_audit(const std::filesystem::path& folder, const CameraModel& camera) {
  inspection::AuditOptions options;
  options.camera = camera;
  std::cout << '\n' << inspection::report_table(inspection::audit_recording(folder, options));
}

/// False when Ctrl-C came before the end.
bool import_frames(importing::ForeignRecording& recording, importing::RecordingFolder& folder,
                   Console& console, const std::stop_token& stop) {
  const std::string all = " of " + std::to_string(recording.size()) + " frames";
  const bool complete = importing::add_frames(recording, folder, stop, [&](std::size_t frames) {
    if (frames % 10 == 0) console.status(std::to_string(frames) + all);
  });
  console.status("");
  return complete;
}

void import_recording(const ImportArguments& arguments) {
  const importing::Layout& layout = arguments.layout.empty()
                                        ? importing::layout_of(arguments.recording)
                                        : importing::layout_named(arguments.layout);
  const auto recording = layout.open(arguments.recording, options_of(arguments, layout));
  importing::RecordingFolder folder(arguments.output);
  Console console(arguments.quiet);
  int signal = 0;
  {
    const Interrupt interrupt([&console](const std::string& line) { console.line(line); });
    if (import_frames(*recording, folder, console, interrupt.token()))
      folder.commit(recording->truth(), "version: 1\n" + camera_yaml(recording->camera()));
    else
      signal = Interrupt::signal();
  }
  if (signal != 0) {
    folder.discard();
    console.line("stopped; nothing was imported");
    std::raise(signal);  // so that a calling script sees that it was interrupted
  }
  for (const std::string& note : recording->notes()) console.note("note: " + note);
  if (arguments.quiet) return;
  std::cout << arguments.recording << " (" << layout.title << ") is now "
            << arguments.output.string() << "\n"
            << what_became_of_images(folder) << '\n';
  print_audit(arguments.output, recording->camera());
}

std::string all_layouts() {
  std::vector<std::string> names;
  for (const importing::Layout& layout : importing::layouts()) names.emplace_back(layout.name);
  return join(names, "|");
}

}  // namespace

void add_import(CLI::App& app) {
  auto arguments = std::make_shared<ImportArguments>();
  CLI::App* command =
      app.add_subcommand("import", "Turn a recording of another data set into a TUM-format one");
  command->add_option("recording", arguments->recording, "Its folder, or the .sens file of ScanNet")
      ->type_name("PATH")
      ->required();
  command->add_option("-o,--output", arguments->output, "New folder for the recording")
      ->type_name("DIR")
      ->required();
  command
      ->add_option("--layout", arguments->layout,
                   "Layout of the recording; default: detected from its files")
      ->type_name(all_layouts());
  command
      ->add_option("--camera", arguments->camera,
                   "Camera of the colour images, to which depth is registered: a file, or the name "
                   "of one in configs/cameras; default: that of the data set or of the recording")
      ->type_name("CAMERA");
  command->add_option("--frames", arguments->frames, "Stop after this many frames")
      ->check(CLI::PositiveNumber)
      ->type_name("N");
  command->add_flag("-q,--quiet", arguments->quiet, "Print only warnings and errors");
  command->callback([arguments] { import_recording(*arguments); });
}

}  // namespace stillpoint
