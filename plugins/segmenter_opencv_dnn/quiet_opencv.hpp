// OpenCV prints the exceptions that it throws to stderr as well; here they are reported anyway.
#pragma once

#include <opencv2/core/utility.hpp>
#include <opencv2/core/utils/logger.hpp>

namespace stillpoint::segmenter_opencv_dnn {

/// OpenCV prints nothing while one of these lives; for the whole process, as OpenCV keeps it.
class QuietOpenCv {
 public:
  QuietOpenCv()
      : level_(cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT)),
        callback_(cv::redirectError(&ignore, nullptr, &data_)) {}
  ~QuietOpenCv() {
    cv::redirectError(callback_, data_);
    cv::utils::logging::setLogLevel(level_);
  }
  QuietOpenCv(const QuietOpenCv&) = delete;
  QuietOpenCv& operator=(const QuietOpenCv&) = delete;

 private:
  static int ignore(int, const char*, const char*, const char*, int, void*) { return 0; }

  void* data_ = nullptr;  // before callback_, whose initialisation fills it
  cv::utils::logging::LogLevel level_;
  cv::ErrorCallback callback_;
};

}  // namespace stillpoint::segmenter_opencv_dnn
