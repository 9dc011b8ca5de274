// stillpoint record: the frames of any source, as a recording.
#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "commands.hpp"
#include "console.hpp"
#include "interrupt.hpp"
#include "progress.hpp"
#include "recorders.hpp"
#include "shell_word.hpp"
#include "stillpoint/engine/engine.hpp"
#include "stillpoint/engine/make_stages.hpp"
#include "stillpoint/engine/stage_error.hpp"
#include "stillpoint/engine/stage_guard.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;

struct RecordArguments {
  PipelineRequest request;
  fs::path output;
  bool quiet = false;
};

/// What has become of the frames, at the end.
class RecordingTotals final : public Output {
 public:
  void finish(const RunSummary& summary) override {
    recorded = summary.poses.size();
    dropped = summary.dropped_frames;
    skipped = summary.source.skipped;
    seconds = summary.recorded_seconds;
  }

  std::size_t recorded = 0;
  int dropped = 0;
  std::size_t skipped = 0;
  double seconds = 0;  // from the first frame to the last
};

/// All but the source is left out; it has a thread of its own, and so has the recorder.
PipelineConfig source_alone(const PipelineConfig& whole) {
  PipelineConfig config{.file = whole.file,
                        .recording = whole.recording,
                        .camera = whole.camera,
                        .source = whole.source,
                        .runtime = whole.runtime};
  config.runtime.mode = RuntimeOptions::Mode::kThreaded;
  return config;
}

template <class Function>
auto of_source(const Stages& stages, Function function) {
  return in_stage("source (" + stages.source.type + ")", {},
                  [&] { return std::invoke(function, *stages.source.object); });
}

void copy_ground_truth(const fs::path& truth, const fs::path& folder) {
  if (truth.empty() || !fs::is_directory(folder)) return;
  std::error_code error;
  fs::copy_file(truth, folder / "groundtruth.txt", error);
  if (error)
    throw Error(Fault::kUsage, "cannot be copied: " + error.message(), truth.string(),
                "check the free space");
}

void print(const RecordingTotals& totals, const RecordArguments& arguments) {
  std::array<char, 128> text{};
  std::snprintf(text.data(), text.size(), "%zu frames of %.1f s, %d dropped", totals.recorded,
                totals.seconds, totals.dropped);
  std::cout << "recorded  " << text.data();
  if (totals.skipped > 0) std::cout << ", " << totals.skipped << " images left out";
  const std::string target = arguments.output.string();
  std::cout << '\n';
  if (fs::exists(arguments.output)) std::cout << "files     " << target << '\n';
  if (totals.recorded > 0) {
    std::cout << "run       stillpoint run PIPELINE --dataset " << shell_word(target);
    if (fs::is_directory(arguments.output))
      std::cout << " --camera " << shell_word(target + "/camera.yaml");
    std::cout << '\n';
  }
  std::cout << std::flush;
}

/// What was recorded until a failure is a recording, and counted.
void record_frames(Stages stages, const RuntimeOptions& runtime, const RecordArguments& arguments,
                   Console& console, std::stop_token stop) {
  copy_ground_truth(of_source(stages, &Source::ground_truth), arguments.output);
  const auto totals = std::make_shared<RecordingTotals>();
  stages.outputs.push_back({{totals, "totals"}});
  Engine engine(std::move(stages), runtime, {});
  try {
    engine.run(std::move(stop));
  } catch (const Error& error) {
    if (!arguments.quiet) print(*totals, arguments);
    if (StageGuard::has_ended_a_call()) {  // nothing more of its plugin is to be run
      std::cerr << "error: " << error.what() << std::endl;
      std::_Exit(error.exit_code());
    }
    throw;
  }
  if (!arguments.quiet) print(*totals, arguments);
  if (totals->dropped > 0)
    console.line("warning: " + std::to_string(totals->dropped) +
                 " frames were dropped: writing did not keep pace; a faster disk or 'nice' for "
                 "other programs helps");
}

void record(const RecordArguments& arguments) {
  require_new(arguments.output);
  Console console(arguments.quiet);
  std::optional<LateCalls> loading(watch_loading());
  Registry registry;
  const PipelineConfig config = source_alone(load_pipeline(arguments.request, registry));
  loading.reset();
  const LateCalls late(config.runtime.stage_timeout, [&console](const std::string& text) {
    console.line("warning: " + text + "; Ctrl-C stops the recording");
  });
  Stages stages = make_stages(config, {}, [&console](LogLevel level, std::string_view text) {
    if (level >= LogLevel::kWarning) console.line("warning: " + std::string(text));
  });
  stages.outputs.push_back(
      {{make_recorder(arguments.output, config.camera.value_or(CameraModel{})), "recorder"}});
  if (!arguments.quiet)
    stages.outputs.push_back({{std::make_shared<Progress>(console, of_source(stages, &Source::size),
                                                          Progress::Of::kRecording),
                               "progress"}});
  int signal = 0;
  {
    const Interrupt interrupt([&console](const std::string& line) { console.line(line); });
    record_frames(std::move(stages), config.runtime, arguments, console, interrupt.token());
    signal = Interrupt::signal();
  }
  if (signal == 0) return;
  console.line("warning: stopped; what was recorded until then is complete");
  std::raise(signal);  // so that a calling script sees that it was interrupted
}

}  // namespace

void add_record(CLI::App& app) {
  auto arguments = std::make_shared<RecordArguments>();
  CLI::App* command = app.add_subcommand(
      "record", "Write the frames of a pipeline's source as a TUM-format folder or an MCAP file");
  add_pipeline_options(*command, arguments->request);
  command
      ->add_option("-o,--output", arguments->output,
                   "New folder for the recording, or new file that ends in .mcap")
      ->type_name("DIR")
      ->required();
  command->add_flag("-q,--quiet", arguments->quiet, "Print only warnings and errors");
  command->callback([arguments] { record(*arguments); });
}

}  // namespace stillpoint
