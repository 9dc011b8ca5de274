#include "source_simulation/simulation_source.hpp"

namespace stillpoint::source_simulation {

SimulationSource::SimulationSource(const Options& options, const StageContext& context)
    : simulator_(options, context.camera.value_or(simulation::default_camera()), context.threads),
      rectifier_(simulator_.camera()) {}

std::optional<Frame> SimulationSource::next() {
  if (next_ >= simulator_.size()) return std::nullopt;
  const simulation::SimulatedFrame image = simulator_.frame(next_);
  Frame frame = rectifier_.frame(image.time, image.bgr, image.depth);
  frame.index = static_cast<std::uint32_t>(next_++);
  return frame;
}

std::optional<std::size_t> SimulationSource::size() const {
  return static_cast<std::size_t>(simulator_.size());
}

}  // namespace stillpoint::source_simulation
