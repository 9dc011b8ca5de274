#include "stillpoint/runtime/elf_file.hpp"

#include <elf.h>

#include <cstdint>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <vector>

namespace stillpoint {
namespace {

#if defined(__x86_64__)
constexpr Elf64_Half kMachine = EM_X86_64;
#elif defined(__aarch64__)
constexpr Elf64_Half kMachine = EM_AARCH64;
#else
#error "name the ELF machine of this processor"
#endif

/// The words of a fault, on their way to why_not_exporting().
struct Unusable : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class ElfFile {
 public:
  explicit ElfFile(const std::filesystem::path& file)
      : stream_(file, std::ios::binary), size_(std::filesystem::file_size(file)) {
    if (!stream_) throw Unusable("cannot be read");
    check_header();
    for (const auto& segment : read<Elf64_Phdr>(header_.e_phoff, header_.e_phnum))
      if (segment.p_type == PT_LOAD) check_inside(segment.p_offset, segment.p_filesz);
  }

  bool exports(std::string_view symbol) {
    const auto sections = read<Elf64_Shdr>(header_.e_shoff, header_.e_shnum);
    for (const Elf64_Shdr& section : sections) {
      if (section.sh_type != SHT_DYNSYM || section.sh_link >= sections.size()) continue;
      const Elf64_Shdr& names = sections[section.sh_link];
      const auto text = read<char>(names.sh_offset, names.sh_size);
      for (const auto& entry :
           read<Elf64_Sym>(section.sh_offset, section.sh_size / sizeof(Elf64_Sym)))
        if (entry.st_shndx != SHN_UNDEF && name_at(text, entry.st_name) == symbol) return true;
    }
    return false;
  }

 private:
  void check_header() {
    if (size_ < SELFMAG) throw Unusable("not a shared library");
    const auto magic = read<char>(0, SELFMAG);
    if (std::memcmp(magic.data(), ELFMAG, SELFMAG) != 0) throw Unusable("not a shared library");
    header_ = read<Elf64_Ehdr>(0, 1).front();
    if (header_.e_ident[EI_CLASS] != ELFCLASS64 || header_.e_machine != kMachine)
      throw Unusable("built for another processor");
    if (header_.e_type != ET_DYN || header_.e_phentsize != sizeof(Elf64_Phdr))
      throw Unusable("not a shared library");
  }

  void check_inside(std::uint64_t offset, std::uint64_t bytes) const {
    if (offset > size_ || bytes > size_ - offset) throw Unusable("truncated or damaged");
  }

  template <class T>
  std::vector<T> read(std::uint64_t offset, std::uint64_t count) {
    if (count > size_ / sizeof(T)) throw Unusable("truncated or damaged");
    check_inside(offset, count * sizeof(T));
    std::vector<T> values(count);
    stream_.seekg(static_cast<std::streamoff>(offset));
    stream_.read(reinterpret_cast<char*>(values.data()),
                 static_cast<std::streamsize>(count * sizeof(T)));
    if (!stream_) throw Unusable("cannot be read");
    return values;
  }

  static std::string_view name_at(const std::vector<char>& text, std::size_t offset) {
    if (offset >= text.size()) return {};
    return {&text[offset], strnlen(&text[offset], text.size() - offset)};
  }

  std::ifstream stream_;
  std::uint64_t size_;
  Elf64_Ehdr header_{};
};

}  // namespace

std::string why_not_exporting(const std::filesystem::path& file, std::string_view symbol) {
  try {
    if (ElfFile(file).exports(symbol)) return {};
    return "does not export '" + std::string(symbol) +
           "'; a plugin needs STILLPOINT_PLUGIN(…) once";
  } catch (const Unusable& fault) {
    return fault.what();
  } catch (const std::exception&) {  // file_size() of a folder or of nothing
    return "cannot be read";
  }
}

}  // namespace stillpoint
