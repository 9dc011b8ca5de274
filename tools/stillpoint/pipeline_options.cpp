#include <iostream>

#include "commands.hpp"

namespace stillpoint {
namespace {

constexpr double kLoadingPatience = 5.0;  // s

}  // namespace

LateCalls watch_loading() {
  return {kLoadingPatience, [](const std::string& text) {
            std::cerr << "warning: " + text + '\n' << std::flush;
          }};
}

void add_pipeline_options(CLI::App& command, PipelineRequest& request) {
  command
      .add_option("pipeline", request.pipeline,
                  "Pipeline file, or the name of one in configs/pipelines")
      ->type_name("PIPELINE")
      ->required();
  command
      .add_option("--dataset", request.dataset,
                  "Recording to read, a folder or a bag (.bag, .mcap, .db3); replaces source.path")
      ->type_name("PATH");
  command
      .add_option("--camera", request.camera,
                  "Camera file, or the name of one in configs/cameras; replaces the camera section")
      ->type_name("CAMERA");
  command
      .add_option("--set", request.assignments,
                  "Change one setting, as in --set tracker.features=2000; may be repeated")
      ->type_name("KEY.SUB=VALUE")
      ->allow_extra_args(false);
}

}  // namespace stillpoint
