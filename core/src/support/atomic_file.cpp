#include "stillpoint/support/atomic_file.hpp"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>

#include "stillpoint/error.hpp"

namespace stillpoint {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, int error) {
  throw Error(Fault::kUsage, std::string("cannot write: ") + std::strerror(error), path.string(),
              "check the folder's permissions and the free space");
}

/// A name that nothing else on this machine uses, and no process has left: in containers, many have
/// the same number.
std::string temporary_name(const std::filesystem::path& path) {
  static std::atomic<unsigned> number{0};
  std::string name;
  std::error_code none;
  do {
    name =
        path.string() + '.' + std::to_string(::getpid()) + '-' + std::to_string(number++) + ".part";
  } while (std::filesystem::exists(std::filesystem::symlink_status(name, none)));
  return name;
}

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path path)
    : path_(std::move(path)), temporary_(temporary_name(path_)) {
  std::error_code error;
  const std::filesystem::file_status there = std::filesystem::status(path_, error);
  if (std::filesystem::exists(there) && !std::filesystem::is_regular_file(there))
    throw Error(Fault::kUsage, "cannot write: this is a folder, a device or a pipe", path_.string(),
                "choose another name");
  error.clear();
  if (path_.has_parent_path()) std::filesystem::create_directories(path_.parent_path(), error);
  if (error) fail(path_.parent_path(), error.value());
  stream_.open(temporary_, std::ios::binary | std::ios::trunc);
  if (!stream_) fail(path_, errno);
}

AtomicFile::~AtomicFile() {
  stream_.close();
  std::error_code ignored;  // after commit() there is nothing to remove
  std::filesystem::remove(temporary_, ignored);
}

void AtomicFile::flush() {
  if (!stream_.flush()) fail(path_, errno);
}

void AtomicFile::commit() {
  stream_.close();
  if (!stream_) fail(path_, errno);
  std::error_code error;
  std::filesystem::rename(temporary_, path_, error);
  if (error) fail(path_, error.value());
}

}  // namespace stillpoint
