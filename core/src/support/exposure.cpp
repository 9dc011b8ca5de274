#include "stillpoint/support/exposure.hpp"

#include <array>
#include <cstddef>

#include "stillpoint/error.hpp"

namespace stillpoint {

int level_quantile(const cv::Mat& image, double share) {
  if (image.depth() != CV_8U)
    throw Error(Fault::kStage,
                "needs an image of 8 bits, got OpenCV type " + cv::typeToString(image.type()),
                "exposure");
  std::array<std::size_t, 256> counts{};
  const int values = image.cols * image.channels();
  for (int y = 0; y < image.rows; ++y) {
    const auto* row = image.ptr<std::uint8_t>(y);
    for (int x = 0; x < values; ++x) ++counts[row[x]];
  }
  const double wanted = share * static_cast<double>(image.total() * image.channels());
  std::size_t counted = counts[0];
  int level = 0;
  while (level < 255 && static_cast<double>(counted) < wanted)
    counted += counts[static_cast<std::size_t>(++level)];
  return level;
}

}  // namespace stillpoint
