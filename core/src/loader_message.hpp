// Why a library cannot be loaded.
#pragma once

#include <dlfcn.h>

#include <string>
#include <string_view>

namespace stillpoint {

/// What dlopen() or dlsym() said, "PATH: TEXT", without the path, which is known to the reader.
inline std::string loader_message(const std::string& file) {
  const char* said = ::dlerror();
  std::string_view text = said ? said : "for no known reason";
  if (text.starts_with(file + ": ")) text.remove_prefix(file.size() + 2);
  return std::string(text);
}

}  // namespace stillpoint
