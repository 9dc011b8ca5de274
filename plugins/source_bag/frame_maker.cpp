#include "source_bag/frame_maker.hpp"

#include "stillpoint/error.hpp"
#include "stillpoint/support/size_text.hpp"

namespace stillpoint::source_bag {

FrameMaker::FrameMaker(const CameraModel& color) : color_(color) {}

FrameMaker::FrameMaker(const CameraModel& color, const CameraModel& depth,
                       const Pose& color_from_depth)
    : color_(color),
      registration_(
          Registration{.camera = depth,
                       .rectifier = Rectifier(depth),
                       .into_color = {depth.undistorted(), color_.camera(), color_from_depth},
                       .none = cv::Mat::zeros(color.height, color.width, CV_16UC1)}) {}

Frame FrameMaker::frame(double time, const cv::Mat& color, const cv::Mat& depth) const {
  if (!registration_) return color_.frame(time, color, depth);
  Frame frame = color_.frame(time, color, registration_->none);
  frame.depth = registered(depth);
  return frame;
}

cv::Mat FrameMaker::registered(const cv::Mat& depth) const {
  const CameraModel& camera = registration_->camera;
  if (depth.cols != camera.width || depth.rows != camera.height)
    throw Error(Fault::kData, "the depth image has " + size_text(depth.size()) +
                                  " pixels, but its camera '" + camera.name + "' has " +
                                  size_text({camera.width, camera.height}));
  return registration_->into_color.register_image(registration_->rectifier.depth(depth), 1);
}

}  // namespace stillpoint::source_bag
