// Writing PNG images quickly: the format is that of every reader, the compression a fast one.
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>

namespace stillpoint::simulation {

/// CV_8UC3 (BGR), CV_8UC1 or CV_16UC1. Throws Error(kUsage) when the file cannot be written.
void write_png(const std::filesystem::path& file, const cv::Mat& image);

}  // namespace stillpoint::simulation
