// stillpoint simulate: writes a recording of a simulated scene, with true poses and labels.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <future>
#include <iostream>
#include <memory>
#include <thread>

#include "commands.hpp"
#include "scene_file.hpp"
#include "simulation/recording_writer.hpp"

namespace stillpoint {
namespace {

struct Arguments {
  std::string scene;
  std::filesystem::path output;
  std::vector<std::string> assignments;
  int frames = 0;
  int threads = 0;
};

void simulate(const Arguments& arguments) {
  SceneFile file = load_scene(arguments.scene, arguments.assignments);
  if (arguments.frames > 0) file.scene.frames = arguments.frames;
  const int threads = arguments.threads > 0
                          ? arguments.threads
                          : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  simulation::Simulator simulator(file.scene, file.camera, threads);
  simulation::RecordingWriter writer(arguments.output);
  std::ofstream(arguments.output / "camera.yaml") << "version: 1\n" << camera_yaml(file.camera);
  writer.write_ground_truth(simulator, simulator.size());
  const auto begin = std::chrono::steady_clock::now();
  const auto rate = [&](int frames) {
    return frames / std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  std::future<void> written;  // of the frame before: files are written while the next is rendered
  for (int i = 0; i < simulator.size(); ++i) {
    simulation::SimulatedFrame frame = simulator.frame(i);
    if (written.valid()) written.get();
    written = std::async(std::launch::async, [&writer, frame] { writer.write(frame); });
    if ((i + 1) % 100 == 0 || i + 1 == simulator.size())
      std::cout << i + 1 << " of " << simulator.size() << " frames, " << std::lround(rate(i + 1))
                << " per second\n"
                << std::flush;
  }
  if (written.valid()) written.get();
  std::cout << "recording in " << arguments.output.string() << '\n';
}

}  // namespace

void add_simulate(CLI::App& app) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      app.add_subcommand("simulate", "Write a TUM-format recording with true poses and labels");
  command->add_option("scene", arguments->scene, "Scene file, or the name of one in configs/scenes")
      ->type_name("SCENE")
      ->required();
  command->add_option("-o,--output", arguments->output, "New folder for the recording")
      ->type_name("DIR")
      ->required();
  command
      ->add_option("--set", arguments->assignments,
                   "Change one setting, as in --set source.seed=2; may be repeated")
      ->type_name("KEY.SUB=VALUE")
      ->allow_extra_args(false);
  command->add_option("--frames", arguments->frames, "Stop after this many frames")
      ->check(CLI::PositiveNumber);
  command->add_option("--threads", arguments->threads, "Default: one per core")
      ->check(CLI::PositiveNumber);
  command->callback([arguments] { simulate(*arguments); });
}

}  // namespace stillpoint
