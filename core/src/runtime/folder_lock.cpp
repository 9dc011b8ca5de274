#include "stillpoint/engine/folder_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "stillpoint/error.hpp"

namespace stillpoint {

// File systems without locks do without.
FolderLock::FolderLock(const std::filesystem::path& folder)
    : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (descriptor_ < 0)
    throw Error(Fault::kUsage, std::string("cannot be read: ") + std::strerror(errno),
                folder.string(), "choose another folder with -o");
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  ::close(descriptor_);
  throw Error(Fault::kUsage, "another run or study is writing into this folder", folder.string(),
              "wait for it, or choose another folder with -o");
}

FolderLock::~FolderLock() { ::close(descriptor_); }

}  // namespace stillpoint
