// Makes what the source `video` reads from a recording in the format of the TUM RGB-D benchmark:
//   folder_to_video RECORDING OUT
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>
#include <sstream>
#include <stdexcept>
#include <string>

namespace fs = std::filesystem;

namespace {

constexpr double kFramesPerSecond = 30;  // for players only; times.txt says when

void copy_over(const fs::path& from, const fs::path& to) {
  fs::copy_file(from, to, fs::copy_options::overwrite_existing);
}

/// Motion JPEG: OpenCV writes it itself, without FFmpeg.
cv::VideoWriter writer_of(const fs::path& file, cv::Size size) {
  cv::VideoWriter writer(file.string(), cv::CAP_OPENCV_MJPEG,
                         cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), kFramesPerSecond, size);
  if (!writer.isOpened()) throw std::runtime_error(file.string() + ": cannot be written");
  writer.set(cv::VIDEOWRITER_PROP_QUALITY, 95);
  return writer;
}

std::string numbered(int number) {
  std::ostringstream name;
  name << std::setw(6) << std::setfill('0') << number << ".png";
  return name.str();
}

int convert(const fs::path& recording, const fs::path& out) {
  std::ifstream pairs(recording / "associations.txt");
  if (!pairs) throw std::runtime_error("there is no associations.txt in " + recording.string());
  fs::create_directories(out / "depth");
  std::ofstream times(out / "times.txt");
  cv::VideoWriter video;
  int count = 0;
  for (std::string time, colour, depth_time, depth;
       pairs >> time >> colour >> depth_time >> depth;) {
    const cv::Mat image = cv::imread((recording / colour).string());
    if (image.empty()) throw std::runtime_error(colour + " cannot be read");
    if (count == 0) video = writer_of(out / "video.avi", image.size());
    video.write(image);
    copy_over(recording / depth, out / "depth" / numbered(count));
    times << time << '\n';
    ++count;
  }
  for (const char* name : {"camera.yaml", "groundtruth.txt"})
    if (fs::exists(recording / name)) copy_over(recording / name, out / name);
  return count;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 3) throw std::runtime_error("usage: folder_to_video RECORDING OUT");
  std::printf("%d frames in %s\n", convert(argv[1], argv[2]), argv[2]);
} catch (const std::exception& error) {
  std::fprintf(stderr, "folder_to_video: %s\n", error.what());
  return 1;
}
