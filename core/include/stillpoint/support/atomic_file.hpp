// Files that are either complete or not there.
#pragma once

#include <filesystem>
#include <fstream>

#include "stillpoint/export.hpp"

namespace stillpoint {

/// Written beside its place, under a name of its own that ends in .part, and put there by
/// commit(). Without commit(), nothing is left behind.
class STILLPOINT_EXPORT AtomicFile {
 public:
  /// Makes missing folders. Throws Error when the file cannot be made, or what is there is no file.
  explicit AtomicFile(std::filesystem::path path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  std::ostream& stream() { return stream_; }
  /// Where it is meanwhile, for what writes to a file by its name.
  const std::filesystem::path& temporary() const { return temporary_; }
  /// Throws Error when what was written so far finds no room: before the commit() of the first of
  /// several files that belong together.
  void flush();
  /// Throws Error when not everything could be written.
  void commit();

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;
  std::ofstream stream_;
};

}  // namespace stillpoint
