// Writes a simulated recording as a folder of the TUM RGB-D benchmark, with labels and truth.
#pragma once

#include <filesystem>
#include <fstream>

#include "simulation/simulator.hpp"

namespace stillpoint::simulation {

/// rgb/, depth/, labels/, instances/, rgb.txt, depth.txt, associations.txt, groundtruth.txt.
/// Names are time stamps in seconds; labels and instances have those of their colour image.
class RecordingWriter {
 public:
  /// Makes the folder. Throws Error(kUsage) when it holds a recording or cannot be written to.
  explicit RecordingWriter(const std::filesystem::path& folder);

  void write(const SimulatedFrame& frame);
  /// True poses at 100 Hz, from before the first to after the last frame.
  void write_ground_truth(const Simulator& simulator, int frames);

 private:
  std::ofstream open(const char* name, const char* header) const;

  std::filesystem::path folder_;
  std::ofstream colors_;
  std::ofstream depths_;
  std::ofstream associations_;
};

}  // namespace stillpoint::simulation
