#include "live_camera/driver_library.hpp"

#include <dlfcn.h>

#include <utility>

#include "stillpoint/error.hpp"

namespace stillpoint::live_camera {

DriverLibrary::DriverLibrary(std::string file, const std::string& package)
    : file_(std::move(file)), handle_(::dlopen(file_.c_str(), RTLD_NOW | RTLD_LOCAL)) {
  if (handle_) return;
  const char* said = ::dlerror();  // begins with the file
  throw Error(Fault::kUsage, said ? said : file_ + ": cannot be loaded", {},
              "install it, on Debian the package " + package);
}

void* DriverLibrary::symbol(const char* name) const {
  if (void* preloaded = ::dlsym(RTLD_DEFAULT, name)) return preloaded;
  if (void* own = ::dlsym(handle_, name)) return own;
  throw Error(Fault::kUsage, std::string("it has no function ") + name, file_,
              "it is of another version than the one that Stillpoint was built for");
}

}  // namespace stillpoint::live_camera
