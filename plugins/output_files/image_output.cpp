#include "output_files/image_output.hpp"

#include <array>
#include <cstdio>
#include <opencv2/imgcodecs.hpp>

#include "output_files/atomic_file.hpp"

namespace stillpoint {

ImageOutput::ImageOutput(const Options& options, const StageContext& context)
    : options_(options), folder_(context.output_directory / options.folder) {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error)
    throw Error(Fault::kUsage, "cannot make the folder: " + error.message(), folder_.string());
}

void ImageOutput::frame(const FrameReport& report) {
  if (report.frame.index % static_cast<std::uint32_t>(options_.every) != 0) return;
  const char* extension = options_.format == Options::Format::kPng ? ".png" : ".jpg";
  std::vector<unsigned char> bytes;
  cv::imencode(extension, annotated(report, options_.parts), bytes);
  std::array<char, 32> name{};
  std::snprintf(name.data(), name.size(), "%06u%s", report.frame.index, extension);
  AtomicFile file(folder_ / name.data());
  file.stream().write(reinterpret_cast<const char*>(bytes.data()),
                      static_cast<std::streamsize>(bytes.size()));
  file.commit();
}

}  // namespace stillpoint
