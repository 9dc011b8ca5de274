#include "study/text_file.hpp"

#include "stillpoint/error.hpp"
#include "stillpoint/support/atomic_file.hpp"
#include "stillpoint/support/input_file.hpp"

namespace stillpoint::study {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const char* what, const std::string& reason, const fs::path& path) {
  throw Error(Fault::kUsage, std::string(what) + ": " + reason, path.string(),
              "check permissions and free space, or choose another folder with -o");
}

}  // namespace

std::string read_text(const fs::path& file) {
  std::error_code none;
  if (!fs::is_regular_file(file, none)) return {};  // a pipe would be waited for
  return read_input_file(file);
}

void write_text(const fs::path& file, const std::string& text) {
  AtomicFile written(file);
  written.stream() << text;
  written.commit();
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) fail("cannot make the folder", error.message(), folder);
}

void remove_folder(const fs::path& folder) {
  std::error_code error;
  fs::remove_all(folder, error);
  if (error) fail("cannot remove", error.message(), folder);
}

}  // namespace stillpoint::study
