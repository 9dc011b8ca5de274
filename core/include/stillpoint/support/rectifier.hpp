// Turns images as recorded into frames of an ideal pinhole camera.
#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "stillpoint/contracts/camera.hpp"
#include "stillpoint/contracts/frame.hpp"
#include "stillpoint/export.hpp"

namespace stillpoint {

/// `sensor` for images that are rectified already: those of `camera`, without distortion or crop.
STILLPOINT_EXPORT CameraModel rectified(CameraModel sensor, const Camera& camera);

/// Undistorts, crops, and scales depth, with maps computed once. Images must have the size of the
/// camera model. May be called from any thread.
class STILLPOINT_EXPORT Rectifier {
 public:
  /// Throws Error(kUsage) for a model that is none, with a crop outside of the image for instance.
  explicit Rectifier(const CameraModel& model);

  /// The camera of the resulting images.
  const Camera& camera() const { return *camera_; }

  /// A frame, but for its index. `time` in seconds, of the colour image; `bgr` CV_8UC3; `depth` as
  /// depth() takes it. Throws Error(kData) when an image is of another size or type.
  Frame frame(double time, const cv::Mat& bgr, const cv::Mat& depth) const;

  /// CV_8UC3. Bilinear; what the sensor did not see is black. The very same image when there is
  /// neither distortion nor a crop.
  cv::Mat color(const cv::Mat& bgr) const;

  /// CV_16UC1 as recorded, or CV_32FC1 in metres → CV_32FC1 metres, 0 = no measurement or out of
  /// range. Nearest neighbour: a mean over the edge of an object would be a point in empty space.
  cv::Mat depth(const cv::Mat& recorded) const;

 private:
  void check(const cv::Mat& image, const char* name, std::initializer_list<int> types) const;
  template <class Value, class Metres>
  cv::Mat rectified_depth(const cv::Mat& recorded, Metres metres) const;

  CameraModel model_;
  cv::Rect crop_;
  std::shared_ptr<const Camera> camera_;
  std::vector<float> metres_;  // by raw depth; 0 outside the usable range
  // Empty without distortion:
  cv::Mat color_map_;           // CV_16SC2: source pixel
  cv::Mat color_weights_;       // CV_16UC1: where between its neighbours
  std::vector<int> depth_map_;  // index of the source pixel, -1 = outside the image
};

}  // namespace stillpoint
