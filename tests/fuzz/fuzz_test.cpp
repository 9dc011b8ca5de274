// Parsers of files that others wrote get files with mistakes in them: they end, within their
// memory, with a result or with an exception in words.
//
// More cases than usual, or others: STILLPOINT_FUZZ_CASES=1000000 STILLPOINT_FUZZ_SEED=2. The file
// under test is always on disk, so that it is there after a crash.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "fuzz/coverage.hpp"
#include "fuzz/fuzz_target.hpp"
#include "fuzz/mutation.hpp"

// Of AddressSanitizer: a file of 32 KiB is no reason for more memory, and parsers are linked twice,
// with coverage and, unused, without.
extern "C" const char* __asan_default_options() {
  return "max_allocation_size_mb=256:detect_odr_violation=0";
}

namespace stillpoint::testing {
namespace {

constexpr std::uint64_t kCases = 1'000;

std::vector<NamedFuzzTarget> all_targets() {
  std::vector<NamedFuzzTarget> all;
  for (const auto& targets :
       {bag_targets(), configuration_targets(), folder_targets(), image_targets(),
        live_view_targets(), map_targets(), network_targets(), recording_targets()})
    all.insert(all.end(), targets.begin(), targets.end());
  return all;
}

std::uint64_t number_of(const char* variable, std::uint64_t otherwise) {
  const char* text = std::getenv(variable);
  return text ? std::strtoull(text, nullptr, 10) : otherwise;
}

class Fuzz : public ::testing::TestWithParam<NamedFuzzTarget> {
 protected:
  /// Whether the parser went where it had not been before.
  bool run(const Bytes& file) {
    std::ofstream(file_, std::ios::binary)
        .write(reinterpret_cast<const char*>(file.data()),
               static_cast<std::streamsize>(file.size()));
    begin_coverage();
    try {
      target_.parse(file_);
    } catch (const std::runtime_error& error) {  // others say that nobody had thought of this file
      EXPECT_STRNE(error.what(), "") << file_;
    } catch (const std::exception& error) {
      ADD_FAILURE() << file_ << ": " << error.what();
    }
    return new_coverage() > 0;
  }

  const FuzzTarget target_ = GetParam().make();
  const fs::path file_ =
      fs::path(::testing::TempDir()) /
      (std::string("stillpoint_fuzz_") + GetParam().name + "_" + std::to_string(::getpid()));
};

TEST_P(Fuzz, EndsWithAResultOrInWords) {
  std::vector<Bytes> corpus = target_.seeds;
  for (const Bytes& seed : corpus) {
    run(seed);
    ASSERT_NO_THROW(target_.parse(file_)) << "a valid file";
  }
  Mutator mutator(number_of("STILLPOINT_FUZZ_SEED", 1), target_.words);
  const std::uint64_t cases = number_of("STILLPOINT_FUZZ_CASES", kCases);
  for (std::uint64_t i = 0; i < cases && !HasFailure(); ++i) {
    const Bytes& one = corpus[mutator.below(corpus.size())];
    const Bytes& other = corpus[mutator.below(corpus.size())];
    Bytes file = mutator.mutated(one, other);
    target_.repair(file);
    if (run(file)) corpus.push_back(std::move(file));
  }
  RecordProperty("corpus", static_cast<int>(corpus.size()));
  if (!HasFailure()) fs::remove(file_);
}

INSTANTIATE_TEST_SUITE_P(Parsers, Fuzz, ::testing::ValuesIn(all_targets()),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace stillpoint::testing
