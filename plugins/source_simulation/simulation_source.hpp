// Frames of a simulated scene, rendered in memory.
#pragma once

#include <stillpoint/sdk.hpp>

#include "simulation/simulator.hpp"
#include "stillpoint/support/rectifier.hpp"

namespace stillpoint::source_simulation {

class SimulationSource final : public Source {
 public:
  using Options = simulation::SceneOptions;

  SimulationSource(const Options& options, const StageContext& context);

  std::optional<Frame> next() override;
  std::optional<std::size_t> size() const override;

 private:
  simulation::Simulator simulator_;
  Rectifier rectifier_;  // depth as of a recording, to the last bit
  int next_ = 0;
};

}  // namespace stillpoint::source_simulation
