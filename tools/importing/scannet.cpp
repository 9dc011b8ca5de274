#include "importing/scannet.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>

#include "depth_registration/depth_registration.hpp"
#include "importing/images.hpp"
#include "importing/sens_file.hpp"
#include "stillpoint/error.hpp"
#include "stillpoint/support/image_codec.hpp"
#include "stillpoint/support/image_file.hpp"
#include "stillpoint/support/rectifier.hpp"
#include "stillpoint/support/size_text.hpp"

namespace stillpoint::importing {
namespace {

using depth_registration::DepthRegistration;

constexpr double kScanNetRate = 30;  // Hz, where the stamps cannot be used
constexpr int kJpegQuality = 95;

/// The same camera with images of another size; pixel (0, 0) is the centre of the top left one.
Camera scaled(Camera camera, cv::Size size) {
  const double x = static_cast<double>(size.width) / camera.width;
  const double y = static_cast<double>(size.height) / camera.height;
  camera.fx *= x;
  camera.cx = (camera.cx + 0.5) * x - 0.5;
  camera.fy *= y;
  camera.cy = (camera.cy + 0.5) * y - 0.5;
  camera.width = size.width;
  camera.height = size.height;
  return camera;
}

bool rises(const std::vector<SensFrame>& frames, std::uint64_t SensFrame::*time) {
  return std::ranges::adjacent_find(frames, std::ranges::greater_equal{}, time) == frames.end();
}

class ScanNet final : public ForeignRecording {
 public:
  ScanNet(const std::filesystem::path& file, std::size_t most_frames)
      : path_(file.string()),
        file_(file, most_frames),
        size_(file_.depth_camera().width, file_.depth_camera().height),
        color_camera_(scaled(file_.color_camera(), size_)),
        registration_(file_.depth_camera(), color_camera_, file_.color_from_depth()) {
    camera_.name = "scannet";
    camera_.depth_factor = file_.depth_factor();
    camera_ = rectified(camera_, color_camera_);
    if (const cv::Size original = original_size(); original != size_)
      notes_.push_back("colour images were scaled from " + size_text(original) + " to " +
                       size_text(size_) + ", the size of the depth images");
    choose_times();
    read_poses();
  }

  std::size_t size() const override { return file_.frames().size(); }

  ForeignFrame read(std::size_t index) override {
    const cv::Mat depth = registration_.register_image(file_.depth(index), file_.depth_factor());
    return {color(index), new_depth(depth_times_[index], depth)};
  }

 private:
  cv::Size original_size() const {
    return {file_.color_camera().width, file_.color_camera().height};
  }

  StoredImage color(std::size_t index) {
    const std::string where = path_ + ", colour image of frame " + std::to_string(index + 1);
    StoredImage image{.time = color_times_[index], .bytes = file_.color(index)};
    if (file_.color_kind() == SensColor::kJpeg) image.extension = ".jpg";
    if (file_.color_kind() != SensColor::kRaw) {
      const auto stated = stated_image_size(image.bytes);
      if (stated != original_size())
        throw Error(Fault::kData, "is damaged or of another size", where);
      if (original_size() == size_) return image;
    }
    cv::Mat pixels = decoded(image.bytes, where);
    if (pixels.size() != size_) cv::resize(pixels, pixels, size_, 0, 0, cv::INTER_AREA);
    image.extension = ".jpg";
    image.bytes = encode_image(".jpg", pixels, {cv::IMWRITE_JPEG_QUALITY, kJpegQuality});
    return image;
  }

  cv::Mat decoded(std::vector<std::uint8_t>& bytes, const std::string& where) const {
    const cv::Size original = original_size();
    if (file_.color_kind() == SensColor::kRaw) {
      if (bytes.size() != std::size_t{3} * static_cast<unsigned>(original.area()))
        throw Error(Fault::kData, "is of another size", where);
      cv::Mat pixels;
      cv::cvtColor(cv::Mat(original, CV_8UC3, bytes.data()), pixels, cv::COLOR_RGB2BGR);
      return pixels;
    }
    cv::Mat pixels;
    try {
      pixels = decode_image(bytes, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
    } catch (const cv::Exception&) {
      pixels.release();
    }
    if (pixels.size() != original) throw Error(Fault::kData, "cannot be decoded", where);
    return pixels;
  }

  void choose_times() {
    const auto& frames = file_.frames();
    const bool color_rises = rises(frames, &SensFrame::color_time);
    const bool depth_rises = color_rises && rises(frames, &SensFrame::depth_time);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      color_times_.push_back(color_rises ? 1e-6 * static_cast<double>(frames[i].color_time)
                                         : static_cast<double>(i) / kScanNetRate);
      depth_times_.push_back(depth_rises ? 1e-6 * static_cast<double>(frames[i].depth_time)
                                         : color_times_.back());
    }
    if (!color_rises)
      notes_.emplace_back("its time stamps do not rise; frames were stamped at 30 Hz");
    else if (!depth_rises)
      notes_.emplace_back("stamps of depth do not rise; depth has those of colour");
  }

  void read_poses() {
    const Pose depth_from_color = file_.color_from_depth().inverse();
    for (std::size_t i = 0; i < size(); ++i)
      if (const auto& pose = file_.frames()[i].world_from_depth)
        truth_.push_back({color_times_[i], *pose * depth_from_color});
    if (truth_.size() < size())
      notes_.push_back(std::to_string(size() - truth_.size()) + " of " + std::to_string(size()) +
                       " images have no true pose");
  }

  std::string path_;
  SensFile file_;
  cv::Size size_;  // of all images
  Camera color_camera_;
  DepthRegistration registration_;
  std::vector<double> color_times_, depth_times_;  // seconds
};

/// Empty when there is none, or more than one.
std::filesystem::path sens_file_of(const std::filesystem::path& recording) {
  if (std::filesystem::is_regular_file(recording))
    return recording.extension() == ".sens" ? recording : std::filesystem::path();
  std::filesystem::path found;
  for (const std::string& name : file_names(recording)) {
    if (!name.ends_with(".sens")) continue;
    if (!found.empty()) return {};
    found = recording / name;
  }
  return found;
}

}  // namespace

bool is_scannet(const std::filesystem::path& recording) { return !sens_file_of(recording).empty(); }

std::unique_ptr<ForeignRecording> open_scannet(const std::filesystem::path& recording,
                                               const ImportOptions& options) {
  if (options.camera_is_users)
    throw Error(Fault::kUsage, "the recording brings its camera", "--camera", "leave it out");
  const std::filesystem::path file = sens_file_of(recording);
  return std::make_unique<ScanNet>(file.empty() ? recording : file, options.most_frames);
}

}  // namespace stillpoint::importing
