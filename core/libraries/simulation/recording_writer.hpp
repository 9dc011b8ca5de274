// Writes a recording as a folder of the TUM RGB-D benchmark; a simulated one with labels and truth.
#pragma once

#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <string>

#include "simulation/simulator.hpp"

namespace stillpoint::simulation {

/// rgb/, depth/, with `labels` labels/ and instances/; rgb.txt, depth.txt, associations.txt,
/// groundtruth.txt. Names are time stamps in seconds; labels and instances have those of their
/// colour image.
class RecordingWriter {
 public:
  /// Makes the folder. Throws Error(kUsage) when it holds a recording, or a part of one, or cannot
  /// be written to.
  explicit RecordingWriter(const std::filesystem::path& folder, bool labels = true);

  /// May be called by several threads, which share out the frames from the first on. The lists of
  /// images name a frame when all before it are there.
  void write(const SimulatedFrame& frame);
  /// True poses at 100 Hz, from before the first to after the last frame.
  void write_ground_truth(const Simulator& simulator, int frames);

 private:
  struct Names {
    std::string color;  // time stamp and file
    std::string depth;
  };

  std::ofstream open(const char* name, const char* header) const;
  Names write_images(const SimulatedFrame& frame) const;
  void list(int index, const Names& names);

  std::filesystem::path folder_;
  bool labels_;
  std::mutex mutex_;              // of what follows
  std::map<int, Names> waiting_;  // for frames before
  int listed_ = 0;                // frames
  std::ofstream colors_;
  std::ofstream depths_;
  std::ofstream associations_;
};

}  // namespace stillpoint::simulation
