// OpenCV's reader of videos, loaded when one is opened.
#pragma once

#include <filesystem>
#include <memory>
#include <opencv2/videoio.hpp>

namespace stillpoint::source_video {

/// A video file that is open. Throws Error(kData) when there is no such file or OpenCV cannot read
/// it, Error(kUsage) when OpenCV's module is not installed.
std::unique_ptr<cv::VideoCapture> open_video(const std::filesystem::path& file);

}  // namespace stillpoint::source_video
