#include "stillpoint/support/input_file.hpp"

#include <fstream>
#include <system_error>

#include "stillpoint/error.hpp"

namespace stillpoint {

namespace fs = std::filesystem;

std::uintmax_t input_file_size(const fs::path& file, std::uintmax_t most_bytes) {
  const auto fail = [&](const std::string& problem, const std::string& remedy = {}) {
    throw Error(Fault::kData, problem, file.string(), remedy);
  };
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status))
    fail(status.type() == fs::file_type::not_found ? "no such file"
                                                   : "cannot be looked at: " + error.message(),
         "check the path");
  if (!fs::is_regular_file(status)) fail("is no regular file");
  const std::uintmax_t size = fs::file_size(file, error);
  if (error) fail("cannot be looked at: " + error.message());
  if (size > most_bytes)
    fail("has " + std::to_string(size >> 20) + " MiB; such a file has at most " +
         std::to_string(most_bytes >> 20));
  return size;
}

std::string read_input_file(const fs::path& file, std::uintmax_t most_bytes) {
  std::string bytes(input_file_size(file, most_bytes), '\0');
  std::ifstream stream(file, std::ios::binary);
  if (!stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size())))
    throw Error(Fault::kData, "cannot be read", file.string(), "check its permissions");
  return bytes;
}

}  // namespace stillpoint
