#include "fuzz/mutation.hpp"

#include <algorithm>
#include <array>

namespace stillpoint::testing {
namespace {

constexpr std::size_t kLargest = 1 << 15;  // bytes; small files show what large ones would

Bytes piece_of(const Bytes& file, std::size_t begin, std::size_t size) {
  const std::size_t end = std::min(file.size(), begin + size);
  return {file.begin() + static_cast<std::ptrdiff_t>(std::min(begin, end)),
          file.begin() + static_cast<std::ptrdiff_t>(end)};
}

}  // namespace

Bytes Mutator::mutated(Bytes file, const Bytes& other) {
  for (std::size_t changes = 1 + below(8); changes > 0; --changes) change(file, other);
  if (file.size() > kLargest) file.resize(kLargest);
  return file;
}

void Mutator::change(Bytes& file, const Bytes& other) {
  if (file.empty()) return insert(file, other);
  const std::size_t at = below(file.size());
  const auto here = file.begin() + static_cast<std::ptrdiff_t>(at);
  switch (below(9)) {
    case 0:
      *here ^= static_cast<std::uint8_t>(1 << below(8));
      break;
    case 1:
      *here = static_cast<std::uint8_t>(below(256));
      break;
    case 2:
      put_number(file);
      break;
    case 3:
      put_word(file);
      break;
    case 4:
      file.erase(here,
                 here + static_cast<std::ptrdiff_t>(std::min(1 + below(64), file.size() - at)));
      break;
    case 5:
      insert(file, piece_of(file, at, 1 + below(64)));
      break;
    case 6:
      insert(file, piece_of(other, below(other.size()), 1 + below(256)));
      break;
    case 7:
      std::rotate(file.begin() + static_cast<std::ptrdiff_t>(below(at + 1)), here, file.end());
      break;
    default:
      if (below(8) == 0) file.resize(at);
  }
}

void Mutator::put_number(Bytes& file) {
  static constexpr std::array<std::uint64_t, 12> kNumbers = {
      0, 1, 0x7f, 0x80, 0xff, 0x7fff, 0x8000, 0xffff, 0x7fffffff, 0x80000000, 0xffffffff, ~0ULL};
  const std::size_t size = std::size_t{1} << below(4);
  if (file.size() < size) return;
  const std::size_t at = below(file.size() - size + 1);
  const std::uint64_t number = kNumbers[below(kNumbers.size())];
  const bool big_endian = below(2) == 0;
  for (std::size_t i = 0; i < size; ++i)
    file[at + (big_endian ? size - 1 - i : i)] = static_cast<std::uint8_t>(number >> (8 * i));
}

void Mutator::put_word(Bytes& file) {
  if (words_.empty()) return;
  const std::string& word = words_[below(words_.size())];
  insert(file, {word.begin(), word.end()});
}

void Mutator::insert(Bytes& file, const Bytes& piece) {
  file.insert(file.begin() + static_cast<std::ptrdiff_t>(below(file.size() + 1)), piece.begin(),
              piece.end());
}

}  // namespace stillpoint::testing
