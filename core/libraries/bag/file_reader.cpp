#include "bag/file_reader.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

namespace stillpoint::bag {

FileReader::FileReader(std::filesystem::path file) : path_(std::move(file)) {
  std::error_code error;
  if (!std::filesystem::exists(path_, error))
    throw Error(Fault::kData, "no such file", path_.string());
  if (!std::filesystem::is_regular_file(path_, error))  // a pipe would be waited for
    throw Error(Fault::kData, "is no regular file", path_.string());
  size_ = std::filesystem::file_size(path_, error);
  if (error) throw Error(Fault::kData, "cannot be read: " + error.message(), path_.string());
  descriptor_ = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor_ < 0)
    throw Error(Fault::kData, "cannot be opened: " + std::generic_category().message(errno),
                path_.string());
}

FileReader::~FileReader() { ::close(descriptor_); }

ByteSpan FileReader::bytes(std::uint64_t offset, std::size_t count) {
  constexpr std::size_t kBlock = 16 << 10;
  if (offset >= size_) return {};
  count = static_cast<std::size_t>(std::min<std::uint64_t>(count, size_ - offset));
  if (offset < begin_ || offset + count > begin_ + buffer_.size())
    fill(offset, static_cast<std::size_t>(
                     std::min<std::uint64_t>(std::max(count, kBlock), size_ - offset)));
  const ByteSpan from = ByteSpan(buffer_).subspan(static_cast<std::size_t>(offset - begin_));
  return from.first(std::min(count, from.size()));
}

void FileReader::fill(std::uint64_t offset, std::size_t count) {
  buffer_.resize(count);
  begin_ = offset;
  std::size_t filled = 0;
  while (filled < count) {
    const ssize_t got = ::pread(descriptor_, buffer_.data() + filled, count - filled,
                                static_cast<off_t>(offset + filled));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) {
      const std::string reason = std::generic_category().message(errno);
      buffer_.clear();
      throw Error(Fault::kData, "cannot be read: " + reason, path_.string());
    }
    if (got == 0) break;  // it has become shorter
    filled += static_cast<std::size_t>(got);
  }
  buffer_.resize(filled);
}

}  // namespace stillpoint::bag
