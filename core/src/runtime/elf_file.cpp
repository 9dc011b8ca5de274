#include "stillpoint/runtime/elf_file.hpp"

#include <elf.h>

#include <cstdint>
#include <cstring>
#include <fstream>
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

std::uint64_t size_of(const std::filesystem::path& file) {
  std::error_code error;
  const std::uint64_t size = std::filesystem::file_size(file, error);
  if (error) throw UnusableFile("cannot be read");  // a folder, a pipe, or nothing
  return size;
}

class ElfFile {
 public:
  explicit ElfFile(const std::filesystem::path& file)
      : size_(size_of(file)), stream_(file, std::ios::binary) {
    if (!stream_) throw UnusableFile("cannot be read");
    check_header();
    segments_ = read<Elf64_Phdr>(header_.e_phoff, header_.e_phnum);
    for (const Elf64_Phdr& segment : segments_)
      if (segment.p_type == PT_LOAD) check_inside(segment.p_offset, segment.p_filesz);
  }

  std::optional<std::string> exported(std::string_view symbol) {
    const auto sections = read<Elf64_Shdr>(header_.e_shoff, header_.e_shnum);
    for (const Elf64_Shdr& section : sections) {
      if (section.sh_type != SHT_DYNSYM || section.sh_link >= sections.size()) continue;
      const Elf64_Shdr& names = sections[section.sh_link];
      const auto text = read<char>(names.sh_offset, names.sh_size);
      for (const auto& entry :
           read<Elf64_Sym>(section.sh_offset, section.sh_size / sizeof(Elf64_Sym)))
        if (entry.st_shndx != SHN_UNDEF && name_at(text, entry.st_name) == symbol)
          return bytes_of(entry);
    }
    return std::nullopt;
  }

 private:
  void check_header() {
    if (size_ < SELFMAG) throw UnusableFile("not a shared library");
    const auto magic = read<char>(0, SELFMAG);
    if (std::memcmp(magic.data(), ELFMAG, SELFMAG) != 0) throw UnusableFile("not a shared library");
    header_ = read<Elf64_Ehdr>(0, 1).front();
    if (header_.e_ident[EI_CLASS] != ELFCLASS64 || header_.e_machine != kMachine)
      throw UnusableFile("built for another processor");
    if (header_.e_type != ET_DYN || header_.e_phentsize != sizeof(Elf64_Phdr))
      throw UnusableFile("not a shared library");
  }

  std::string bytes_of(const Elf64_Sym& symbol) {
    for (const Elf64_Phdr& segment : segments_) {
      if (segment.p_type != PT_LOAD || symbol.st_value < segment.p_vaddr) continue;
      const std::uint64_t start = symbol.st_value - segment.p_vaddr;
      if (start > segment.p_filesz || symbol.st_size > segment.p_filesz - start) continue;
      const auto bytes = read<char>(segment.p_offset + start, symbol.st_size);
      return {bytes.begin(), bytes.end()};
    }
    throw UnusableFile("truncated or damaged");
  }

  void check_inside(std::uint64_t offset, std::uint64_t bytes) const {
    if (offset > size_ || bytes > size_ - offset) throw UnusableFile("truncated or damaged");
  }

  template <class T>
  std::vector<T> read(std::uint64_t offset, std::uint64_t count) {
    if (count > size_ / sizeof(T)) throw UnusableFile("truncated or damaged");
    check_inside(offset, count * sizeof(T));
    std::vector<T> values(count);
    stream_.seekg(static_cast<std::streamoff>(offset));
    stream_.read(reinterpret_cast<char*>(values.data()),
                 static_cast<std::streamsize>(count * sizeof(T)));
    if (!stream_) throw UnusableFile("cannot be read");
    return values;
  }

  static std::string_view name_at(const std::vector<char>& text, std::size_t offset) {
    if (offset >= text.size()) return {};
    return {&text[offset], strnlen(&text[offset], text.size() - offset)};
  }

  std::uint64_t size_;  // before the stream: a pipe would be waited for
  std::ifstream stream_;
  Elf64_Ehdr header_{};
  std::vector<Elf64_Phdr> segments_;
};

}  // namespace

std::optional<std::string> exported_object(const std::filesystem::path& file,
                                           std::string_view symbol) {
  return ElfFile(file).exported(symbol);
}

}  // namespace stillpoint
