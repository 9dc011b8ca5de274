#include "output_files/image_output.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstdio>
#include <utility>
#include <vector>

#include "output_files/panels.hpp"
#include "stillpoint/support/atomic_file.hpp"
#include "stillpoint/support/image_codec.hpp"

namespace stillpoint::output_files {
namespace {

namespace fs = std::filesystem;

bool is_output_picture(const fs::path& file) {
  const std::string name = file.stem().string();
  return (file.extension() == ".jpg" || file.extension() == ".png") && name.size() >= 6 &&
         std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isdigit(c); });
}

// Otherwise pictures of an earlier run would remain among those of this one.
void remove_pictures(const fs::path& folder) {
  std::vector<fs::path> pictures;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none))
    if (is_output_picture(entry.path())) pictures.push_back(entry.path());
  for (const fs::path& picture : pictures) fs::remove(picture);
}

}  // namespace

ImageOutput::ImageOutput(const Options& options, const StageContext& context)
    : options_(options), folder_(context.output_directory / options.folder) {
  std::error_code none;
  for (fs::path path = folder_; path.has_relative_path(); path = path.parent_path())
    if (fs::exists(path, none) && !fs::is_directory(path, none))
      throw Error(Fault::kUsage, "is no folder: pictures cannot be written into it", path.string(),
                  "choose another one with the option 'folder'");
  if (options.worst == 0) return;
  for (const Badness& badness : {Badness(exclusion), Badness(lack_of_inliers), loss()})
    worst_.emplace_back(static_cast<std::size_t>(options.worst), badness);
}

void ImageOutput::frame(const FrameReport& report) {
  if (!std::exchange(begun_, true)) remove_pictures(folder_);
  if (is_chosen(report.frame->index)) write(report);
  for (WorstFrames& worst : worst_) take(worst.add(report));
}

void ImageOutput::finish(const RunSummary&) {
  for (WorstFrames& worst : worst_) take(worst.finish());
}

bool ImageOutput::is_chosen(std::uint32_t frame) const {
  return frame % static_cast<std::uint32_t>(options_.every) == 0 ||
         std::ranges::find(options_.frames, frame) != options_.frames.end();
}

void ImageOutput::take(const WorstFrames::Change& change) {
  if (change.in) {
    const std::uint32_t frame = change.in->frame->index;
    if (++reasons_[frame] == 1 && !is_chosen(frame)) write(*change.in);
  }
  if (change.out && --reasons_[*change.out] == 0 && !is_chosen(*change.out))
    fs::remove(file_of(*change.out));
}

fs::path ImageOutput::file_of(std::uint32_t frame) const {
  const char* extension = options_.format == Options::Format::kPng ? ".png" : ".jpg";
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), "%06u%s", frame, extension);
  return folder_ / name.data();
}

void ImageOutput::write(const FrameReport& report) const {
  const fs::path path = file_of(report.frame->index);
  const cv::Mat picture = options_.panels ? panels_of(report) : annotated(report, options_.parts);
  const std::vector<std::uint8_t> bytes = encode_image(path.extension().string(), picture);
  AtomicFile file(path);
  file.stream().write(reinterpret_cast<const char*>(bytes.data()),
                      static_cast<std::streamsize>(bytes.size()));
  file.commit();
}

}  // namespace stillpoint::output_files
