#include "study/matrix.hpp"

#include <algorithm>

namespace stillpoint::study {

bool is_wanted(const Variant& variant, const std::string& sequence) {
  const auto names = [&](const std::vector<std::string>& list) {
    return std::ranges::find(list, sequence) != list.end();
  };
  return (variant.only.empty() || names(variant.only)) && !names(variant.skip);
}

std::vector<Cell> cells_of(const Study& study) {
  std::vector<Cell> cells;
  for (std::size_t sequence = 0; sequence < study.sequences.size(); ++sequence)
    for (std::size_t variant = 0; variant < study.variants.size(); ++variant) {
      if (!is_wanted(study.variants[variant], study.sequences[sequence].name)) continue;
      for (int repeat = 0; repeat < study.repeats; ++repeat)
        cells.push_back({sequence, variant, repeat});
    }
  return cells;
}

std::string name_of(const Study& study, const Cell& cell) {
  return study.sequences[cell.sequence].name + "/" + study.variants[cell.variant].name + "/" +
         std::to_string(cell.repeat);
}

std::filesystem::path run_folder(const std::filesystem::path& output, const Study& study,
                                 const Cell& cell) {
  return output / "runs" / name_of(study, cell);
}

std::filesystem::path recording_of(const std::filesystem::path& output, const Study& study,
                                   std::size_t sequence, int repeat) {
  const Sequence& wanted = study.sequences[sequence];
  if (wanted.scene.empty()) return wanted.dataset;
  const auto first = std::ranges::find_if(
      study.sequences, [&](const Sequence& other) { return same_images(other, wanted); });
  return output / "recordings" / at_repeat(study, *first, repeat).name;
}

}  // namespace stillpoint::study
