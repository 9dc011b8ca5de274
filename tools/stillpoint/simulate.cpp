// stillpoint simulate: writes a recording of a simulated scene, with true poses and labels.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "commands.hpp"
#include "scene_file.hpp"
#include "simulation/parallel.hpp"
#include "simulation/recording_writer.hpp"
#include "stillpoint/support/atomic_file.hpp"

namespace stillpoint {
namespace {

struct SimulateArguments {
  std::string scene;
  std::filesystem::path output;
  std::vector<std::string> assignments;
  int frames = 0;
  int threads = 0;
  bool quiet = false;
};

/// Says on standard output how far it is; may be told by several threads.
class Count {
 public:
  Count(int frames, bool quiet) : frames_(frames), quiet_(quiet) {}

  void one_more() {
    const std::scoped_lock lock(mutex_);
    ++done_;
    if (quiet_ || (done_ % 100 != 0 && done_ != frames_)) return;
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin_;
    std::cout << done_ << " of " << frames_ << " frames, " << std::lround(done_ / seconds.count())
              << " per second\n"
              << std::flush;
  }

 private:
  int frames_;
  bool quiet_;
  std::mutex mutex_;
  int done_ = 0;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// Each thread renders whole frames: none waits for another before the last.
void write_frames(const simulation::Simulator& simulator, simulation::RecordingWriter& writer,
                  int threads, bool quiet) {
  std::vector<simulation::Simulator> simulators(static_cast<std::size_t>(threads), simulator);
  Count count(simulator.size(), quiet);
  std::atomic<int> next = 0;
  simulation::parallel_for(threads, threads, [&](int thread) {
    try {
      for (int i = next++; i < simulator.size(); i = next++) {
        writer.write(simulators[static_cast<std::size_t>(thread)].frame(i));
        count.one_more();
      }
    } catch (...) {
      next = simulator.size();  // for all
      throw;
    }
  });
}

void write_camera(const CameraModel& camera, const std::filesystem::path& target) {
  AtomicFile file(target);
  file.stream() << "version: 1\n" << camera_yaml(camera);
  file.commit();
}

void simulate(const SimulateArguments& arguments) {
  SceneFile file = load_scene(arguments.scene, arguments.assignments);
  if (arguments.frames > 0) file.scene.frames = arguments.frames;
  const int threads = arguments.threads > 0
                          ? arguments.threads
                          : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const simulation::Simulator simulator(file.scene, file.camera, 1);
  simulation::RecordingWriter writer(arguments.output);
  write_camera(file.camera, arguments.output / "camera.yaml");
  writer.write_ground_truth(simulator, simulator.size());
  write_frames(simulator, writer, threads, arguments.quiet);
  if (!arguments.quiet) std::cout << "recording in " << arguments.output.string() << '\n';
}

}  // namespace

void add_simulate(CLI::App& app) {
  auto arguments = std::make_shared<SimulateArguments>();
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
  command->add_option("--threads", arguments->threads, "Threads that render; default: one per core")
      ->check(CLI::PositiveNumber);
  command->add_flag("-q,--quiet", arguments->quiet, "Print only warnings and errors");
  command->callback([arguments] { simulate(*arguments); });
}

}  // namespace stillpoint
