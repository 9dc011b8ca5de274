#include "source_simulation/simulation_source.hpp"

#include <opencv2/imgproc.hpp>

namespace stillpoint::source_simulation {

SimulationSource::SimulationSource(const Options& options, const StageContext& context)
    : simulator_(options, context.camera.value_or(simulation::default_camera()), context.threads),
      camera_(std::make_shared<const Camera>(simulator_.camera().undistorted())) {}

std::optional<Frame> SimulationSource::next() {
  if (next_ >= simulator_.size()) return std::nullopt;
  const simulation::SimulatedFrame image = simulator_.frame(next_);
  Frame frame{.index = static_cast<std::uint32_t>(next_++),
              .time = image.time,
              .bgr = image.bgr,
              .camera = camera_};
  cv::cvtColor(frame.bgr, frame.gray, cv::COLOR_BGR2GRAY);
  image.depth.convertTo(frame.depth, CV_32F, 1 / simulator_.camera().depth_factor);
  return frame;
}

std::optional<std::size_t> SimulationSource::size() const {
  return static_cast<std::size_t>(simulator_.size());
}

}  // namespace stillpoint::source_simulation
