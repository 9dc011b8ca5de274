#include "study/folder_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "stillpoint/error.hpp"

namespace stillpoint::study {

FolderLock::FolderLock(const std::filesystem::path& folder)
    : descriptor_(open((folder / ".lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)) {
  if (descriptor_ < 0)
    throw Error(Fault::kUsage, std::string("cannot write: ") + std::strerror(errno),
                folder.string(), "choose another folder with -o");
  if (flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
  close(descriptor_);
  throw Error(Fault::kUsage, "another study is running in this folder", folder.string(),
              "wait for it, or choose another folder with -o");
}

FolderLock::~FolderLock() { close(descriptor_); }

}  // namespace stillpoint::study
