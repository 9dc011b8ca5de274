#include "source_video/late_capture.hpp"

#include <new>
#include <opencv2/core/utils/logger.hpp>
#include <string>

#include "live_camera/driver_library.hpp"
#include "stillpoint/error.hpp"

namespace stillpoint::source_video {
namespace {

namespace logging = cv::utils::logging;

/// OpenCV's own complaints are not printed while it exists.
class QuietOpenCv {
 public:
  QuietOpenCv() : before_(logging::setLogLevel(logging::LOG_LEVEL_SILENT)) {}
  ~QuietOpenCv() { logging::setLogLevel(before_); }
  QuietOpenCv(const QuietOpenCv&) = delete;
  QuietOpenCv& operator=(const QuietOpenCv&) = delete;

 private:
  logging::LogLevel before_;
};

/// All functions of the class but its constructor are virtual: this one is looked up, and nothing
/// needs to be linked.
std::unique_ptr<cv::VideoCapture> make_capture() {
  static const live_camera::DriverLibrary videoio(STILLPOINT_VIDEOIO, "libopencv-videoio406");
  auto* const construct = videoio.function<void(void*)>("_ZN2cv12VideoCaptureC1Ev");
  void* const memory = ::operator new(sizeof(cv::VideoCapture));
  construct(memory);
  return std::unique_ptr<cv::VideoCapture>(static_cast<cv::VideoCapture*>(memory));
}

}  // namespace

std::unique_ptr<cv::VideoCapture> open_video(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file))
    throw Error(Fault::kData, "there is no such file", file.string(),
                "the option 'video' says what it is called in the folder");
  auto video = make_capture();
  const QuietOpenCv quiet;
  if (!video->open(file.string()))
    throw Error(Fault::kData, "OpenCV cannot read this as a video", file.string(),
                "convert it to H.264 or MJPEG");
  return video;
}

}  // namespace stillpoint::source_video
