#include "stillpoint/engine/map_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <exception>
#include <string>
#include <system_error>

#include "stillpoint/error.hpp"
#include "stillpoint/runtime/map_reader.hpp"
#include "stillpoint/runtime/map_values.hpp"
#include "stillpoint/runtime/map_writer.hpp"
#include "stillpoint/support/atomic_file.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void cannot_write(const fs::path& file, const std::string& why) {
  throw Error(Fault::kUsage, "the map cannot be written: " + why, file.string(),
              "check the folder's permissions and the free space");
}

// Of a map made by hand: what the stages of a run give is checked where it enters the runtime.
void require_loadable(const SparseMap& map, const fs::path& file) {
  try {
    for (KeyFrameId id = 0; id < map.keyframe_id_end(); ++id)
      if (const KeyFrame* keyframe = map.keyframe(id)) {
        if (!keyframe->camera || !keyframe->features)
          throw DamagedMap("a key frame has no camera or no features");
        check_values(*keyframe->camera);
        check_values(*keyframe);
      }
    for (LandmarkId id = 0; id < map.landmark_id_end(); ++id)
      if (const Landmark* landmark = map.landmark(id)) check_values(*landmark);
    if (const auto fault = map.check()) throw DamagedMap(*fault);
  } catch (const DamagedMap& fault) {
    throw Error(Fault::kUsage, std::string("the map could not be loaded again: ") + fault.what(),
                file.string(), "it is not written; correct these values");
  }
}

// Writes to the disk, so that the renamed file is complete even after a power cut.
void flush(const fs::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  const bool flushed = descriptor >= 0 && ::fsync(descriptor) == 0;
  const int error = errno;
  if (descriptor >= 0) ::close(descriptor);
  if (!flushed) throw std::system_error(error, std::generic_category());
}

}  // namespace

void require_writable(const fs::path& file) { const AtomicFile tried(file); }

void save_map(const SparseMap& map, const fs::path& file) {
  require_loadable(map, file);
  AtomicFile whole(file);
  try {
    write_map(map, whole.temporary());
    flush(whole.temporary());
  } catch (const std::exception& fault) {
    cannot_write(file, fault.what());
  }
  whole.commit();
}

SparseMap load_map(const fs::path& file) {
  const auto refuse = [&](const std::string& why) {
    return Error(Fault::kData, "this map cannot be used: " + why, file.string(),
                 "give a file that 'stillpoint run --save-map' of this version has written");
  };
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) throw refuse("there is no such file");
  try {
    return read_map(file);
  } catch (const std::exception& fault) {
    throw refuse(fault.what());
  }
}

}  // namespace stillpoint
