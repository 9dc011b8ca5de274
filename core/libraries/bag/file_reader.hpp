// A file read here and there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "bag/byte_reader.hpp"

namespace stillpoint::bag {

/// Of any size; reads what is asked for and a little of what follows. One per thread.
class FileReader {
 public:
  /// Throws Error(kData) when there is no such file, or it cannot be read.
  explicit FileReader(std::filesystem::path file);
  ~FileReader();
  FileReader(const FileReader&) = delete;
  FileReader& operator=(const FileReader&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::uint64_t size() const { return size_; }  ///< bytes, as it was when it was opened

  /// `count` bytes from `offset` on, fewer where the file ends; valid until the next call. Throws
  /// Error(kData) when the disk fails.
  ByteSpan bytes(std::uint64_t offset, std::size_t count);

 private:
  void fill(std::uint64_t offset, std::size_t count);

  std::filesystem::path path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
  std::uint64_t begin_ = 0;  // of the buffer in the file
  std::vector<std::uint8_t> buffer_;
};

}  // namespace stillpoint::bag
