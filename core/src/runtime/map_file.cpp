#include "stillpoint/engine/map_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <exception>
#include <string>
#include <system_error>

#include "stillpoint/error.hpp"
#include "stillpoint/runtime/map_reader.hpp"
#include "stillpoint/runtime/map_writer.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void cannot_write(const fs::path& file, const std::string& why) {
  throw Error(Fault::kUsage, "the map cannot be written: " + why, file.string(),
              "check the folder's permissions and the free space");
}

// Writes to the disk, so that the renamed file is complete even after a power cut.
void flush(const fs::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  const bool flushed = descriptor >= 0 && ::fsync(descriptor) == 0;
  const int error = errno;
  if (descriptor >= 0) ::close(descriptor);
  if (!flushed) throw std::system_error(error, std::generic_category());
}

// Written beside its place first, under a name that no other process on this machine has.
fs::path part_of(const fs::path& file) {
  return file.string() + '.' + std::to_string(::getpid()) + ".part";
}

}  // namespace

void require_writable(const fs::path& file) {
  std::error_code failed;
  if (file.has_parent_path()) fs::create_directories(file.parent_path(), failed);
  if (failed) cannot_write(file, failed.message());
  if (fs::exists(file, failed) && !fs::is_regular_file(file, failed))
    throw Error(Fault::kUsage, "the map cannot be written: this is a folder, a device or a pipe",
                file.string(), "choose another name");
  const int descriptor = ::open(part_of(file).c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0644);
  if (descriptor < 0) cannot_write(file, std::strerror(errno));
  ::close(descriptor);
  fs::remove(part_of(file), failed);
}

void save_map(const SparseMap& map, const fs::path& file) {
  const fs::path part = part_of(file);
  require_writable(file);
  try {
    write_map(map, part);
    flush(part);
    fs::rename(part, file);
  } catch (const std::exception& fault) {
    std::error_code ignored;
    fs::remove(part, ignored);
    cannot_write(file, fault.what());
  }
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
