// Changes files the way damage, other writers and attackers do.
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "fuzz/fuzz_target.hpp"

namespace stillpoint::testing {

class Mutator {
 public:
  Mutator(std::uint64_t seed, std::vector<std::string> words)
      : random_(seed), words_(std::move(words)) {}

  /// One to eight changes: bits, bytes, numbers of 1, 2, 4 or 8 bytes at their limits, words,
  /// pieces left out, doubled, moved or taken from `other`, an end that is missing.
  Bytes mutated(Bytes file, const Bytes& other);
  std::size_t below(std::size_t end) { return end == 0 ? 0 : random_() % end; }

 private:
  void change(Bytes& file, const Bytes& other);
  void put_number(Bytes& file);
  void put_word(Bytes& file);
  void insert(Bytes& file, const Bytes& piece);

  std::mt19937_64 random_;
  std::vector<std::string> words_;
};

}  // namespace stillpoint::testing
